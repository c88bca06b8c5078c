// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of a layout with prescribed directions, eliminated exactly: the remaining degrees of freedom.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "cut/transitions.hpp"
#include "repair/newton.hpp"

namespace lsgp {

// Halfedges and their directions in the layout, unit vectors.
struct DirectedEdges {
  Array<Index> halfedges;
  Array<Complex> directions;
  Array<Index> held{};  // copies that stay at 0
};

// Positions and translations under the condition that the edges keep their directions. Redundant equations are left
// out; contradictory ones leave edges without length.
DegreesOfFreedom free_along(const CutSurface& surface, const Reduction& reduction, const DirectedEdges& edges);

}  // namespace lsgp
