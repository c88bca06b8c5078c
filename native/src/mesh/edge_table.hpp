// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a surface's triangles, before any of them is known to be manifold.
#pragma once

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// The undirected edges of the triangles; every edge lists its halfedges.
class EdgeTable {
 public:
  // Leaves out the triangles marked to skip and those that name a vertex twice; their halfedges have no edge.
  EdgeTable(const Surface& surface, const PerTriangle<char>& skip);

  Index count() const { return static_cast<Index>(first_.size()) - 1; }
  Index edge_of(Index halfedge) const { return edge_of_halfedge_[halfedge]; }
  Index halfedge_count(Index edge) const { return first_[edge + 1] - first_[edge]; }
  Index halfedge(Index edge, Index i) const { return entries_[first_[edge] + i].halfedge; }

  // The edge between two vertices, or none.
  Index find(Index a, Index b) const;

 private:
  struct Entry {
    Index high, halfedge;
    bool operator<(const Entry& other) const {
      return high != other.high ? high < other.high : halfedge < other.halfedge;
    }
  };
  Array<Index> bucket_;  // entries by their edge's lower vertex
  Array<Entry> entries_;
  Array<Index> first_;  // the first entry of each edge
  Array<Index> edge_of_entry_;
  PerHalfedge<Index> edge_of_halfedge_;
};

// The halfedge on the other side of each edge that two triangles share, or none. They may run in the same direction.
PerHalfedge<Index> other_sides(const EdgeTable& edges, Index halfedge_count);

}  // namespace lsgp
