// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary polygon of a layout.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// The directed boundary edges of a layout, loop by loop, with the layout on their left.
class BoundaryPolygon {
 public:
  // position, twin: as of has_overlap.
  BoundaryPolygon(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin);
  // Of a part of a mesh.  halfedges: where it may end.  ends_at(h), position_of(h): whether it ends there, and where
  // the halfedge begins.  traced: (halfedges of the mesh) 0, and again afterward.
  template <typename EndsAt, typename PositionOf>
  BoundaryPolygon(const HalfedgeMesh& mesh, const Array<Index>& halfedges, EndsAt ends_at, PositionOf position_of,
                  PerHalfedge<char>& traced);

  Index edge_count() const { return static_cast<Index>(tail_.size()); }
  Complex tail(Index edge) const { return tail_[edge]; }
  Complex head(Index edge) const { return head_[edge]; }
  // Whether an edge begins where the one numbered before it ends.
  bool runs_on(Index edge) const { return loops_[loop_[edge]] != edge; }

  // Whether a layout without flipped triangles overlaps itself.
  bool has_overlap() const { return touches_itself() || encloses_itself(); }

  bool touches_itself() const;

  // Whether the layout overlaps itself, provided that its boundary consists of simple curves that do not touch.
  bool encloses_itself() const;

 private:
  template <typename EndsAt, typename PositionOf>
  void trace_loop(const PerHalfedge<Index>& twin, Index first, EndsAt ends_at, PositionOf position_of,
                  PerHalfedge<char>& traced);
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

template <typename EndsAt, typename PositionOf>
BoundaryPolygon::BoundaryPolygon(const HalfedgeMesh& mesh, const Array<Index>& halfedges, EndsAt ends_at,
                                 PositionOf position_of, PerHalfedge<char>& traced) {
  for (const Index first : halfedges) {
    if (!traced[first] && ends_at(first)) trace_loop(mesh.twin, first, ends_at, position_of, traced);
  }
  loops_.push_back(edge_count());
  for (const Index h : halfedges) traced[h] = 0;
}

template <typename EndsAt, typename PositionOf>
void BoundaryPolygon::trace_loop(const PerHalfedge<Index>& twin, Index first, EndsAt ends_at, PositionOf position_of,
                                 PerHalfedge<char>& traced) {
  loops_.push_back(edge_count());
  for (Index h = first; !traced[h];) {
    traced[h] = 1;
    tail_.push_back(position_of(h));
    head_.push_back(position_of(next(h)));
    loop_.push_back(static_cast<Index>(loops_.size()) - 1);
    h = next(h);
    while (!ends_at(h)) h = next(twin[h]);
  }
}

}  // namespace lsgp
