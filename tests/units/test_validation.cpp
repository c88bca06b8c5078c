// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/validation.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <limits>

#include "mesh/edge_table.hpp"

TEST_CASE("three corners of every element have numbers, or there are too many") {
  const std::ptrdiff_t most = std::numeric_limits<lsgp::Index>::max() / 3;
  CHECK_NOTHROW(lsgp::require_countable(0, "triangles"));
  CHECK_NOTHROW(lsgp::require_countable(most, "triangles"));
  CHECK_THROWS_AS(lsgp::require_countable(most + 1, "triangles"), lsgp::Error);
  CHECK_THROWS_AS(lsgp::require_countable(std::numeric_limits<std::ptrdiff_t>::max(), "triangles"), lsgp::Error);
}

TEST_CASE("no edge has an end that is no vertex") {
  lsgp::Surface surface;
  surface.positions = lsgp::Positions::Zero(3, 3);
  surface.triangles.resize(1, 3);
  surface.triangles << 0, 1, 2;
  const lsgp::EdgeTable edges(surface, lsgp::PerTriangle<char>(1, 0));
  CHECK(edges.find(2, 1) == edges.edge_of(1));
  constexpr lsgp::Index least = std::numeric_limits<lsgp::Index>::min();
  constexpr lsgp::Index most = std::numeric_limits<lsgp::Index>::max();
  for (const lsgp::Index v : {least, -1, 3, most - 1, most}) {
    CHECK(edges.find(v, v) == lsgp::none);
    CHECK(edges.find(v, 1) == lsgp::none);
    CHECK(edges.find(1, v) == lsgp::none);
  }
}
