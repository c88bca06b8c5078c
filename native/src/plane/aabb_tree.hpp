// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of intersecting axis-aligned boxes in the plane, and those that meet another one.
#pragma once

#include <algorithm>
#include <utility>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Closed, sides parallel to the axes.
struct Box {
  double left, right, bottom, top;
};

inline bool meet(const Box& a, const Box& b) {
  // Without branches, which would be unpredictable.
  return static_cast<int>(a.left <= b.right) & static_cast<int>(b.left <= a.right) &
         static_cast<int>(a.bottom <= b.top) & static_cast<int>(b.bottom <= a.top);
}

inline Box around(const Box& a, const Box& b) {
  return {std::min(a.left, b.left), std::max(a.right, b.right), std::min(a.bottom, b.bottom), std::max(a.top, b.top)};
}

// A binary tree of boxes in the order of a space-filling curve, halved by count: robust to boxes of very different
// sizes and to clusters.
class AabbTree {
 public:
  explicit AabbTree(const Array<Box>& boxes);

  // Calls visit(i, j), i < j, for every two boxes that meet, in a fixed order.
  template <typename Visit>
  void for_each_meeting_pair(Visit visit) const {
    const auto goes_on = [&](Index i, Index j) {
      visit(i, j);
      return false;
    };
    any_meeting_pair(goes_on);
  }

  // Whether is(i, j) holds for any of them; none is looked at after that.
  template <typename Is>
  bool any_meeting_pair(Is is) const {
    Array<std::pair<Index, Index>> open;  // nodes
    if (!nodes_.empty()) open.emplace_back(0, 0);
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      checkpoint(operations_a_node);
      const Node &first = nodes_[a], &second = nodes_[b];
      if (a == b) {
        if (!first.is_leaf())
          open.insert(open.end(), {{a + 1, a + 1}, {first.right, first.right}, {a + 1, first.right}});
        else if (any_pair(first, is))
          return true;
      } else if (meet(first.box, second.box)) {
        if (first.is_leaf() && second.is_leaf()) {
          if (any_pair(first, second, is)) return true;
        } else if (second.is_leaf() || (!first.is_leaf() && first.count() >= second.count())) {
          open.insert(open.end(), {{a + 1, b}, {first.right, b}});
        } else {
          open.insert(open.end(), {{a, b + 1}, {a, second.right}});
        }
      }
    }
    return false;
  }

  // Whether is(i) holds for any box that meets this one; none is looked at after that.
  template <typename Is>
  bool any_meeting(const Box& box, Is is) const {
    Array<Index> open;  // nodes
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
      const Index a = open.back();
      open.pop_back();
      const Node& node = nodes_[a];
      if (!meet(node.box, box)) continue;
      if (!node.is_leaf()) {
        open.insert(open.end(), {a + 1, node.right});
        continue;
      }
      for (Index i = node.begin; i < node.end; ++i) {
        if (meet(box_[i], box) && is(item_[i])) return true;
      }
    }
    return false;
  }

 private:
  static constexpr double operations_a_node = 20;

  struct Node {
    Box box;
    Index begin, end;  // in item_
    Index right;       // node of the second half, the first half's follows its parent; none for a leaf
    bool is_leaf() const { return right < 0; }
    Index count() const { return end - begin; }
  };

  Index build(Index begin, Index end);

  template <typename Is>
  bool any_pair(const Node& node, Is& is) const {
    for (Index i = node.begin; i < node.end; ++i) {
      for (Index j = i + 1; j < node.end; ++j) {
        if (meet(box_[i], box_[j]) && is(std::min(item_[i], item_[j]), std::max(item_[i], item_[j]))) return true;
      }
    }
    return false;
  }
  template <typename Is>
  bool any_pair(const Node& a, const Node& b, Is& is) const {
    for (Index i = a.begin; i < a.end; ++i) {
      if (!meet(box_[i], b.box)) continue;
      for (Index j = b.begin; j < b.end; ++j) {
        if (meet(box_[i], box_[j]) && is(std::min(item_[i], item_[j]), std::max(item_[i], item_[j]))) return true;
      }
    }
    return false;
  }

  Array<Index> item_;  // the boxes in the order of the leaves
  Array<Box> box_;     // theirs
  Array<Node> nodes_;
};

}  // namespace lsgp
