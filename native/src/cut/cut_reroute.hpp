// SPDX-License-Identifier: GPL-3.0-or-later
// Another way for one cut between the same ends, while all other cuts stay.
#pragma once

#include "cut/shortest_paths.hpp"

namespace lsgp {

// The cuts of a component, one of which moves.
struct MovedCut {
  Array<Index> path;           // its halfedges from end to end; a closed one ends where it begins
  PerHalfedge<char> is_other;  // edges of all other cuts, on both halfedges
  PerVertex<char> is_node;     // vertices that the cut must not be moved onto
};

// Refers to the mesh.
class CutReroute {
 public:
  // cut: its path is not empty.
  CutReroute(const MetricMesh& surface, MovedCut cut);

  const Array<Index>& path() const { return cut_.path; }

  // The cheapest way from the first end to a vertex, and from there to the last end, as halfedges; if these would meet
  // before the vertex, the second one gives way. Throws CUT_NOT_MOVABLE.
  Array<Index> way_through(Index v) const;

  // How often the transition from the left to the right side of the cut applies to each triangle, so that the layout
  // is open along the way instead. 0 beside all other cuts and on the larger side; throws CUT_NOT_MOVABLE if
  // that is impossible.
  PerTriangle<int> powers(const Array<Index>& way) const;

 private:
  PerVertex<Reached> grow_from(Index end) const;
  Array<Index> way_back(const PerVertex<Reached>& reached, Index v) const;
  Array<Index> way_around(Index v, const Array<Index>& avoided) const;
  PerHalfedge<int> jumps(const Array<Index>& way) const;
  int rest(const Array<Index>& moved, const PerTriangle<int>& power) const;

  const HalfedgeMesh& mesh_;
  const CutEdges edges_;
  MovedCut cut_;
  Index tail_, head_;
  PerVertex<char> is_closed_to_;  // vertices that ways avoid, both ends included
  PerVertex<Reached> from_tail_, from_head_;
};

}  // namespace lsgp
