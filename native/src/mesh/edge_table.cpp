// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edge_table.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lsgp {

EdgeTable::EdgeTable(const Surface& surface, const PerTriangle<char>& skip) {
  const Triangles& triangles = surface.triangles;
  const auto for_each_halfedge = [&](auto visit) {
    for (Index f = 0; f < triangles.rows(); ++f) {
      if (skip[f] || is_collapsed(triangles, f)) continue;
      const Index a = triangles(f, 0), b = triangles(f, 1), c = triangles(f, 2);
      visit(3 * f, a, b);
      visit(3 * f + 1, b, c);
      visit(3 * f + 2, c, a);
    }
  };
  bucket_.assign(surface.positions.rows() + 1, 0);
  for_each_halfedge([&](Index, Index tail, Index head) { ++bucket_[std::min(tail, head) + 1]; });
  std::partial_sum(bucket_.begin(), bucket_.end(), bucket_.begin());
  const Index used = bucket_.back();
  entries_.resize(used);
  Array<Index> cursor(bucket_.begin(), bucket_.end() - 1);
  for_each_halfedge(
      [&](Index h, Index tail, Index head) { entries_[cursor[std::min(tail, head)]++] = {std::max(tail, head), h}; });
  edge_of_entry_.resize(used);
  edge_of_halfedge_.assign(3 * triangles.rows(), none);
  for (std::size_t v = 0; v + 1 < bucket_.size(); ++v) {
    std::sort(entries_.begin() + bucket_[v], entries_.begin() + bucket_[v + 1]);
    for (Index i = bucket_[v]; i < bucket_[v + 1]; ++i) {
      if (i == bucket_[v] || entries_[i].high != entries_[i - 1].high) first_.push_back(i);
      edge_of_entry_[i] = edge_of_halfedge_[entries_[i].halfedge] = static_cast<Index>(first_.size()) - 1;
    }
  }
  first_.push_back(used);
}

Index EdgeTable::find(Index a, Index b) const {
  const Index low = std::min(a, b), high = std::max(a, b);
  if (low < 0 || high >= ssize(bucket_) - 1) return none;
  const auto begin = entries_.begin() + bucket_[low], end = entries_.begin() + bucket_[low + 1];
  const auto at = std::lower_bound(begin, end, Entry{high, 0});
  return at != end && at->high == high ? edge_of_entry_[at - entries_.begin()] : none;
}

PerHalfedge<Index> other_sides(const EdgeTable& edges, Index halfedge_count) {
  PerHalfedge<Index> out(halfedge_count, none);
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (edges.halfedge_count(edge) != 2) continue;
    const Index a = edges.halfedge(edge, 0), b = edges.halfedge(edge, 1);
    out[a] = b;
    out[b] = a;
  }
  return out;
}

}  // namespace lsgp
