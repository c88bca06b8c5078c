// SPDX-License-Identifier: GPL-3.0-or-later
// What the flat metric has to satisfy along the surface's borders.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry.hpp"
#include "topology.hpp"

namespace lsgp {

struct BorderConditions {
  std::vector<char> held;     // (n) log scale 0 there; the angle comes out as it may
  Eigen::VectorXd curvature;  // (n) imposed where not held, beside that of cones
  // No vertex is held: all curvatures together have to satisfy Gauss-Bonnet.
  bool balanced = false;
};

// Borders keep their scale and turn freely, but for corners, whose angle is imposed.
BorderConditions free_border(const HalfedgeMesh& mesh, const std::vector<Index>& corners);

// Borders run straight between corners.  A border vertex with a single triangle cannot lie on a straight line: it keeps
// its shape, a tooth on the straight line through its neighbours.
BorderConditions straight_border(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Index>& corners);

// The border edges on both sides of each corner: with their directions imposed, a free border meets its corners.
std::vector<Index> corner_edges(const HalfedgeMesh& mesh, const std::vector<Index>& corners);

// The edges that make up the straight lines: border halfedges, and in place of a tooth's two its base, seen from the
// triangle below it.
std::vector<Index> straight_edges(const HalfedgeMesh& mesh, const std::vector<Index>& corners);

}  // namespace lsgp
