// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary conditions of the flat metric.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct BorderConditions {
  Array<char> held;           // (n) log scale 0 there; the angle comes out as it may
  Eigen::VectorXd curvature;  // (n) imposed where not held, beside that of cones
  // No vertex is held: all curvatures together have to satisfy Gauss-Bonnet.
  bool balanced = false;
};

// Borders keep their scale and turn freely, but for corners, whose angle is imposed.
BorderConditions free_border(const HalfedgeMesh& mesh, const Array<Index>& corners);

// Borders run straight between corners. A border vertex with a single triangle cannot lie on a straight line: it keeps
// its shape, a tooth on the straight line through its neighbours.
BorderConditions straight_border(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Index>& corners);

// The border edges on both sides of each corner: with their directions imposed, a free border meets its corners.
Array<Index> corner_edges(const HalfedgeMesh& mesh, const Array<Index>& corners);

// The edges that make up the straight lines: border halfedges, and in place of a tooth's two its base, seen from the
// triangle below it.
Array<Index> straight_edges(const HalfedgeMesh& mesh, const Array<Index>& corners);

}  // namespace lsgp
