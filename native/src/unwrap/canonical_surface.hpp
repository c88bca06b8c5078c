// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as its shape alone gives it, so that neither its numbering nor moving, turning or scaling it changes what
// is chosen for it.
#pragma once

#include <vector>

#include "base/array.hpp"
#include "lsgp/auto_unwrap.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// Triangles and vertices are numbered component by component, in breadth-first order from an outermost halfedge. The
// middle of all corners is at the origin, the farthest one 1 away from it, and the first vertex of the component whose
// first one is the farthest on the x axis. Positions are rounded to quanta far above what turning them loses and far
// below what triangles need; not where some are too thin for that. Nothing is moved where sides are too short to be
// turned, and one-sided components keep their numbering.
class CanonicalSurface {
 public:
  // Throws EDGE_NOT_IN_MESH, SEAM_NOT_AN_EDGE and OUT_OF_MEMORY.
  explicit CanonicalSurface(const Surface& given);

  const Surface& surface() const { return surface_; }

  // What is given for that surface, for this one.
  Cones of(const Cones& given) const;
  AutoUnwrapOptions of(const AutoUnwrapOptions& given) const;

  // What came out for this one, for that one. Islands are numbered in the order of their first triangles, cones in that
  // of their vertices, in a placement the given ones first.
  void restore(const Cones& given, Unwrapped& unwrapped) const;
  Error restored(const Error& error) const;

 private:
  VertexPairs renumbered(VertexPairs pairs) const;
  VertexPairs of(const VertexPairs& given) const;  // sorted
  void number(const Surface& given, const Array<Index>& corners);
  void carry(const Surface& given, const Eigen::Matrix3d& frame);

  void restore(Elements& elements) const;
  void restore(std::vector<Finding>& findings) const;
  void restore(std::vector<Index>& vertices) const;
  void restore(VertexPairs& pairs) const;
  void restore(Eigen::VectorXd& at_vertices) const;
  void restore(CornerUv& corner_uv) const;
  void restore(SeamlessReport& report) const;
  void restore(Result& result) const;
  void restore_sorted(const std::vector<Index>& first, std::vector<Index>& cones, std::vector<double>& angles) const;
  void restore_sorted_triangles(std::vector<Index>& triangles) const;

  Surface surface_;
  double size_ = 1;                   // of the given surface, relative to this one
  PerVertex<Index> own_vertex_;       // of the given surface's
  PerVertex<Index> source_vertex_;    // the given surface's
  PerTriangle<Index> source_corner_;  // the given surface's corner, 3 * triangle + corner, that each begins with
};

}  // namespace lsgp
