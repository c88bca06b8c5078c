// SPDX-License-Identifier: GPL-3.0-or-later
// Another way for one cut between the same ends, while all other cuts stay.
#pragma once

#include "cut/shortest_paths.hpp"

namespace lsgp {

// The cuts of a component, one of which moves.
struct MovedCut {
  Array<Index> path;     // its halfedges from end to end; a closed one ends where it begins
  Array<char> is_other;  // (3m) edges of all other cuts, on both halfedges
  Array<char> is_node;   // (n) vertices that the cut must not be moved onto
};

// Refers to the mesh.
class CutReroute {
 public:
  // cut: its path is not empty.
  CutReroute(const HalfedgeMesh& mesh, const Geometry& geometry, MovedCut cut);

  const Array<Index>& path() const { return cut_.path; }

  // The cheapest way from the first end to a vertex, and from there to the last end, as halfedges; if these would meet
  // before the vertex, the second one gives way. Throws CUT_NOT_MOVABLE.
  Array<Index> way_through(Index v) const;

  // How often the transition from the left to the right side of the cut applies to each triangle, (m), so that the
  // layout is open along the way instead. 0 beside all other cuts and on the larger part; throws CUT_NOT_MOVABLE if
  // that is impossible.
  Array<int> powers(const Array<Index>& way) const;

 private:
  Array<Reached> grow_from(Index end) const;
  Array<Index> way_back(const Array<Reached>& reached, Index v) const;
  Array<Index> way_around(Index v, const Array<Index>& avoided) const;
  Array<int> jumps(const Array<Index>& way) const;
  int rest(const Array<Index>& moved, const Array<int>& power) const;

  const HalfedgeMesh& mesh_;
  const CutEdges edges_;
  MovedCut cut_;
  Index tail_, head_;
  Array<char> is_closed_to_;              // (n) vertices that ways avoid, both ends included
  Array<Reached> from_tail_, from_head_;  // (n)
};

}  // namespace lsgp
