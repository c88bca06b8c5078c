// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/radix_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "random_matrices.hpp"

TEST_CASE("numbers of any size are in order, equal ones as they were") {
  Random random(1);
  for (const int count : {0, 1, 2, 500}) {
    lsgp::Array<double> numbers;
    for (int i = 0; i < count; ++i) {
      numbers.push_back(below(random, 4) == 0 ? below(random, 3) : std::exp(between(random, -600, 600)));
    }
    if (count > 2) {
      numbers[1] = std::numeric_limits<double>::infinity();
      numbers[2] = std::numeric_limits<double>::denorm_min();
    }
    lsgp::Array<lsgp::Index> expected(count);
    std::iota(expected.begin(), expected.end(), 0);
    std::stable_sort(expected.begin(), expected.end(),
                     [&](lsgp::Index a, lsgp::Index b) { return numbers[a] < numbers[b]; });
    CHECK(lsgp::radix_order(numbers) == expected);
  }
}
