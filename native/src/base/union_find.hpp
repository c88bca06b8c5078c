// SPDX-License-Identifier: GPL-3.0-or-later
// Disjoint sets; each is represented by its lowest member.
#pragma once

#include <algorithm>
#include <numeric>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

class UnionFind {
 public:
  explicit UnionFind(Index size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  bool unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  Array<Index> parent_;
};

}  // namespace lsgp
