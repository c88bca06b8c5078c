// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary polygon of a layout.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// The directed boundary edges of a layout, loop by loop, with the layout on their left.
class BoundaryPolygon {
 public:
  // position, twin: as of has_overlap.
  BoundaryPolygon(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin);

  Index edge_count() const { return static_cast<Index>(tail_.size()); }
  Complex tail(Index edge) const { return tail_[edge]; }
  Complex head(Index edge) const { return head_[edge]; }
  // Whether an edge begins where the one numbered before it ends.
  bool runs_on(Index edge) const { return loops_[loop_[edge]] != edge; }

  bool touches_itself() const;

  // Whether the layout overlaps itself, provided that its boundary consists of simple curves that do not touch.
  bool encloses_itself() const;

 private:
  bool follows(Index i, Index j) const;
  // Whether two edges have, or may have, a common point other than the corner between consecutive edges.
  bool touch(Index i, Index j) const;
  // Whether an edge folds back onto the one before it.
  bool folds_back(Index i, Index j) const;
  // How often the layout covers the point just left of the leftmost point of a loop.
  int covers_left_of(Complex point, Index loop) const;

  Array<Complex> tail_, head_;  // (edges)
  Array<Index> loop_;           // (edges)
  Array<Index> loops_;          // the first edge of each, and the end
};

}  // namespace lsgp
