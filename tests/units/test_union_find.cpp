// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/union_find.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "random_matrices.hpp"

TEST_CASE("the lowest member stands for a set") {
  Random random(1);
  const lsgp::Index size = 60;
  lsgp::UnionFind sets(size);
  std::vector<lsgp::Index> label(static_cast<std::size_t>(size));
  for (lsgp::Index i = 0; i < size; ++i) label[static_cast<std::size_t>(i)] = i;
  for (int round = 0; round < 50; ++round) {
    const lsgp::Index a = below(random, size), b = below(random, size);
    const lsgp::Index one = label[static_cast<std::size_t>(a)], other = label[static_cast<std::size_t>(b)];
    CHECK(sets.unite(a, b) == (one != other));
    for (lsgp::Index& each : label) {
      if (each == std::max(one, other)) each = std::min(one, other);
    }
    for (lsgp::Index i = 0; i < size; ++i) CHECK(sets.find(i) == label[static_cast<std::size_t>(i)]);
  }
}
