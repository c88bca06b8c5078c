// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/array.hpp"
#include "cut/cut_network.hpp"
#include "cut/shortest_paths.hpp"

namespace lsgp {

// The Voronoi regions of the vertices of the cuts, and the edges between them, at the time of the last update: paths
// through them stay valid while the cuts at their ends exist (Mehlhorn 1988; Uchoa and Werneck 2012).
class CutRegions {
 public:
  explicit CutRegions(const CutNetwork& network);

  // Only regions with changes grow again.  below: a bound on the cost of the paths to be found; more expensive ones
  // take longer.
  void update(double below);

  // The cheapest path between the two subtrees of the cuts after closing a path, with the regions of the path's
  // vertices distributed over the others; empty if none is below a cost. is_apart: marks the vertices of one of them by
  // `mark`.
  CutPath find(const CutPath& closed, const PerVertex<Index>& is_apart, Index mark, double below);

 private:
  void grow(double below);
  void regrow_changed();
  PathStarts enter(double below, PerVertex<Reached>& reached) const;
  void list();
  const Reached& at(Index v) const { return redone_[v] == round_ ? again_[v] : reached_[v]; }
  void redo(const CutPath& closed, double below);
  CutPath path_through(Index bridge) const;

  const CutNetwork& network_;
  PerHalfedge<char> was_cut_;
  Array<Index> sources_;  // the vertices of the cuts
  double below_ = 0;      // what the paths cost whose halves are all reached
  PerVertex<Reached> reached_;
  Array<Index> first_, members_;  // the vertices of each region
  Array<Bridge> bridges_;         // cheapest first
  PerVertex<Reached> again_;      // of the vertices whose region's cut was closed
  PerVertex<Index> redone_;       // the last round that did so
  Array<Index> around_;           // these vertices
  Index round_ = 0;
};

}  // namespace lsgp
