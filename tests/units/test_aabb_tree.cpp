// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/aabb_tree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "random_matrices.hpp"

namespace {

using Pairs = std::set<std::pair<lsgp::Index, lsgp::Index>>;

Pairs all_pairs(const lsgp::Array<lsgp::Box>& boxes) {
  Pairs out;
  for (lsgp::Index i = 0; i < lsgp::ssize(boxes); ++i) {
    for (lsgp::Index j = i + 1; j < lsgp::ssize(boxes); ++j) {
      const lsgp::Box &a = boxes[i], &b = boxes[j];
      const bool apart = a.right < b.left || b.right < a.left || a.top < b.bottom || b.top < a.bottom;
      if (!apart) out.emplace(i, j);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a tree of boxes finds every two that meet, once") {
  Random random(1);
  for (const int count : {0, 1, 2, 8, 9, 100, 700}) {
    for (const double size : {0.0, 0.05, 1.0}) {
      CAPTURE(count);
      CAPTURE(size);
      lsgp::Array<lsgp::Box> boxes;
      for (int i = 0; i < count; ++i) {
        // Some crowd in one place, some are a thousand times as large.
        const double spread = i % 3 == 0 ? 1e-3 : 1, scale = i % 17 == 0 ? 1000 : 1;
        const double x = spread * between(random, -1, 1), y = spread * between(random, -1, 1);
        boxes.push_back({x, x + scale * size * between(random, 0, 1), y, y + scale * size * between(random, 0, 1)});
      }
      Pairs found;
      int visits = 0;
      lsgp::AabbTree(boxes).for_each_meeting_pair([&](lsgp::Index i, lsgp::Index j) {
        found.emplace(i, j);
        ++visits;
      });
      CHECK(found == all_pairs(boxes));
      CHECK(static_cast<std::size_t>(visits) == found.size());
    }
  }
}

TEST_CASE("a tree of boxes finds those that meet another one, once") {
  Random random(2);
  const auto box = [&](double size) {
    const double x = between(random, -1, 1), y = between(random, -1, 1);
    return lsgp::Box{x, x + size * between(random, 0, 1), y, y + size * between(random, 0, 1)};
  };
  for (const int count : {0, 1, 8, 9, 300}) {
    CAPTURE(count);
    lsgp::Array<lsgp::Box> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(box(i % 17 == 0 ? 1 : 0.1));
    const lsgp::AabbTree tree(boxes);
    for (const double size : {0.0, 0.3}) {
      const lsgp::Box other = box(size);
      std::multiset<lsgp::Index> found, expected;
      CHECK(!tree.any_meeting(other, [&](lsgp::Index i) {
        found.insert(i);
        return false;
      }));
      for (lsgp::Index i = 0; i < lsgp::ssize(boxes); ++i) {
        if (lsgp::meet(boxes[i], other)) expected.insert(i);
      }
      CHECK(found == expected);
      CHECK(tree.any_meeting(other, [](lsgp::Index) { return true; }) == !expected.empty());
    }
  }
}

TEST_CASE("boxes that share a point alone meet") {
  const lsgp::Array<lsgp::Box> boxes{{0, 1, 0, 1}, {1, 2, 1, 2}, {3, 4, 0, 4}};
  int visits = 0;
  lsgp::AabbTree(boxes).for_each_meeting_pair([&](lsgp::Index i, lsgp::Index j) {
    CHECK(i == 0);
    CHECK(j == 1);
    ++visits;
  });
  CHECK(visits == 1);
}

TEST_CASE("a box around nothing meets none") {
  constexpr double far = std::numeric_limits<double>::infinity();
  const lsgp::Array<lsgp::Box> boxes{{far, -far, far, -far}, {0, 2, 0, 2}, {1, 3, 1, 3}};
  Pairs found;
  lsgp::AabbTree(boxes).for_each_meeting_pair([&](lsgp::Index i, lsgp::Index j) { found.emplace(i, j); });
  CHECK(found == Pairs{{1, 2}});
}
