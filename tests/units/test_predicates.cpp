// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "plane/predicates.hpp"
#include "random_matrices.hpp"

TEST_CASE("the side of a line is never told wrong, and told where rounding leaves no doubt") {
  Random random(1);
  int told = 0;
  constexpr int rounds = 20000;
  for (int round = 0; round < rounds; ++round) {
    // Whole coordinates: the determinant is exact in 64 bits.  The third point lies on the line or a step beside it.
    const auto coordinate = [&] { return static_cast<long long>(random() % 2000001) - 1000000; };
    const long long ax = coordinate(), ay = coordinate(), dx = coordinate(), dy = coordinate();
    const long long times = below(random, 5) - 2;
    const long long cx = ax + times * dx + below(random, 3) - 1, cy = ay + times * dy + below(random, 3) - 1;
    const long long exact = dx * (cy - ay) - dy * (cx - ax);
    const auto point = [](long long x, long long y) {
      return lsgp::Complex(static_cast<double>(x), static_cast<double>(y));
    };
    const int side = lsgp::side(point(ax, ay), point(ax + dx, ay + dy), point(cx, cy));
    if (side != 0) {
      CHECK(side == (exact > 0) - (exact < 0));
      ++told;
    } else {
      // Within the last digits of its products.
      const double products =
          std::abs(static_cast<double>(dx * (cy - ay))) + std::abs(static_cast<double>(dy * (cx - ax)));
      CHECK(std::abs(static_cast<double>(exact)) <= 1e-15 * products);
    }
  }
  CHECK(told > rounds / 2);
}
