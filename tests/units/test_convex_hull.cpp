// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "plane/convex_hull.hpp"
#include "random_matrices.hpp"

namespace {

using lsgp::Complex;

double noise(Random& random) { return between(random, -1e-15, 1e-15); }

// Corners of a regular polygon with a vertical side on its left.
Eigen::VectorXcd regular(int sides, double stretch) {
  Eigen::VectorXcd out(sides);
  for (int i = 0; i < sides; ++i) {
    const Complex corner = std::polar(1.0, M_PI + 2 * M_PI * (i + 0.5) / sides);
    out[i] = {corner.real(), stretch * corner.imag()};
  }
  return out;
}

}  // namespace

TEST_CASE("rounding does not choose among the smallest boxes around a polygon") {
  Random random(7);
  for (const double stretch : {0.5, 1.0, 2.0}) {
    for (const int sides : {4, 6, 8}) {
      const Eigen::VectorXcd corners = regular(sides, stretch);
      const Complex expected = lsgp::longer_side(lsgp::convex_hull(corners));
      for (int round = 0; round < 50; ++round) {
        Eigen::VectorXcd moved = corners;
        for (Complex& z : moved) z += Complex(noise(random), noise(random));
        CHECK(std::abs(lsgp::longer_side(lsgp::convex_hull(moved)) - expected) <= 1e-13);
      }
    }
  }
}

TEST_CASE("the smallest box around a turned rectangle lies along its longer side") {
  for (int i = 0; i < 12; ++i) {
    const Complex along = std::polar(1.0, 0.3 + i);
    Eigen::VectorXcd corners(4);
    corners << Complex(0, 0), 3.0 * along, Complex(3, 2) * along, Complex(0, 2) * along;
    CHECK(std::abs(std::imag(lsgp::longer_side(lsgp::convex_hull(corners)) / along)) <= 1e-15);
  }
}

TEST_CASE("the hull of points at one place is that point, and of points on a line their ends") {
  for (const int count : {1, 2, 5}) {
    const Eigen::VectorXcd same = Eigen::VectorXcd::Constant(count, Complex(0.3, -2));
    const auto hull = lsgp::convex_hull(same);
    REQUIRE(!hull.empty());
    for (const Complex z : hull) CHECK(z == same[0]);
  }
  Eigen::VectorXcd line(3);
  line << Complex(1, 1), Complex(3, 3), Complex(2, 2);
  const auto ends = lsgp::convex_hull(line);
  REQUIRE(ends.size() == 2);
  CHECK(ends[0] == Complex(1, 1));
  CHECK(ends[1] == Complex(3, 3));
}
