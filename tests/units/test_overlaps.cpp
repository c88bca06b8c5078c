// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles of a layout overlap but for rounding.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plane/overlaps.hpp"
#include "random_matrices.hpp"

using namespace lsgp;

namespace {

// Two triangles along one segment, the second with a vertex in its middle that lies so far inside the first one.
Eigen::VectorXcd along_open_seam(Random& random, double depth) {
  const Complex from(between(random, 1, 100), between(random, 1, 100));
  const Complex along = std::polar(1.0, between(random, 0, 2 * M_PI)), across = along * Complex(0, 1);
  Eigen::VectorXcd out(6);
  out << from, from + along, from + along / 2.0 + across, from, from + along / 2.0 - across,
      from + along / 2.0 + depth * across;
  return out;
}

void store(Eigen::VectorXcd& position) {
  for (Complex& z : position) z = {static_cast<float>(z.real()), static_cast<float>(z.imag())};
}

}  // namespace

TEST_CASE("what storing a layout in float32 moves does not overlap") {
  Random random(3);
  int moved = 0;
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXcd position = along_open_seam(random, 0);
    CHECK(find_overlaps(position).empty());
    store(position);
    if (!find_overlaps(position).empty()) ++moved;
    CHECK(find_overlaps(position, Rounding::stored).empty());
  }
  CHECK(moved > 0);
}

TEST_CASE("what overlaps by more than that does so once it is stored") {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXcd position = along_open_seam(random, 0.01);
    store(position);
    REQUIRE(find_overlaps(position, Rounding::stored).size() == 1);
  }
}
