// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary conditions of the flat metric.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct BorderConditions {
  PerVertex<char> held;       // log scale 0 (Dirichlet); the angle is free
  Eigen::VectorXd curvature;  // (n) imposed where not held, beside that of cones
  // No vertex is held: the curvatures have to satisfy Gauss-Bonnet.
  bool balanced = false;
};

// Boundaries keep their scale and have free angles, except at corners, whose angle is imposed.
BorderConditions free_border(const HalfedgeMesh& mesh, const Array<Index>& corners);

// Boundaries are straight between corners. A boundary vertex with a single triangle cannot lie on a straight line: it
// keeps its shape, a tooth on the straight line through its neighbors.
BorderConditions straight_border(const MetricMesh& surface, const Array<Index>& corners);

// The boundary edges on both sides of each corner: imposing their directions makes the corners of a free boundary
// exact.
Array<Index> corner_edges(const HalfedgeMesh& mesh, const Array<Index>& corners);

// The edges of the straight lines: boundary halfedges, with the two of a tooth replaced by its base, seen from the
// triangle below it.
Array<Index> straight_edges(const HalfedgeMesh& mesh, const Array<Index>& corners);

}  // namespace lsgp
