// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/bucket_queue.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "random_matrices.hpp"

namespace {

// Searches with steps of 0 and from 1 / spread to spread: whether what is popped is always the least entry.
void check_order(double bucket_width, double spread) {
  Random random(1);
  lsgp::BucketQueue queue(bucket_width);
  std::multiset<lsgp::BucketQueue::Entry> expected;
  const auto push = [&](double distance) {
    const lsgp::Index vertex = below(random, 100);
    queue.push(distance, vertex);
    expected.emplace(distance, vertex);
  };
  for (int i = 0; i < 20; ++i) push(below(random, 1000));
  int pushes = 2000;
  while (!expected.empty()) {
    REQUIRE(!queue.empty());
    REQUIRE(queue.pop() == *expected.begin());
    const double nearest = expected.begin()->first;
    expected.erase(expected.begin());
    for (lsgp::Index more = below(random, 4); more > 0 && pushes > 0; --more, --pushes) {
      const double exponent = below(random, 2001) / 1000.0 - 1;
      push(nearest + (below(random, 8) == 0 ? 0 : std::pow(spread, exponent)));
    }
  }
  CHECK(queue.empty());
  CHECK(pushes == 0);
}

}  // namespace

TEST_CASE("the nearest comes first whatever the steps are") {
  for (const double spread : {1.0, 3.0, 1e3, 1e9}) {
    for (const double width : {0.0, 1e-310, 1e-6, 0.25, 1e6, 1e308}) {
      CAPTURE(spread);
      CAPTURE(width);
      check_order(width, spread);
    }
  }
}

TEST_CASE("a bucket that has been begun tells what comes next") {
  lsgp::BucketQueue queue(1);
  for (const lsgp::Index v : {4, 2, 7}) queue.push(0.1 * v, v);
  CHECK(queue.ahead(1) == lsgp::none);
  CHECK(queue.pop().second == 2);
  CHECK(queue.ahead(1) == 4);
  CHECK(queue.ahead(2) == 7);
  CHECK(queue.ahead(3) == lsgp::none);
}
