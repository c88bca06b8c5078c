// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <utility>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Edges whatever their direction.
class EdgeSet {
 public:
  template <typename Pairs>
  explicit EdgeSet(const Pairs& edges) {
    edges_.reserve(edges.rows());
    for (Eigen::Index e = 0; e < edges.rows(); ++e) edges_.push_back(std::minmax<Index>(edges(e, 0), edges(e, 1)));
    sort_unique(edges_);
  }

  bool has(Index a, Index b) const {
    return std::binary_search(edges_.begin(), edges_.end(), std::pair<Index, Index>(std::minmax(a, b)));
  }

 private:
  Array<std::pair<Index, Index>> edges_;
};

// The rows of edges for which `is_kept(row)`.
template <typename Predicate>
VertexPairs filtered(const VertexPairs& edges, Predicate is_kept) {
  VertexPairs out(edges.rows(), 2);
  Eigen::Index count = 0;
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    if (is_kept(e)) out.row(count++) = edges.row(e);
  }
  out.conservativeResize(count, 2);
  return out;
}

// One row for each pair.
inline VertexPairs to_rows(const Array<std::pair<Index, Index>>& pairs) {
  VertexPairs out(ssize(pairs), 2);
  for (std::ptrdiff_t e = 0; e < ssize(pairs); ++e) out.row(e) << pairs[e].first, pairs[e].second;
  return out;
}

}  // namespace lsgp
