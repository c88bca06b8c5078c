// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of coarsely modelled round surfaces, which bend as much as creases do: rings of a torus with six or eight
// sides.
#pragma once

#include "mesh/topology.hpp"

namespace lsgp {

// Whether the surface goes on bending on both sides of an inner edge as it does there: alike, and after faces of about
// one width.  bend: (3m) radians between the normals at an edge.
bool is_round(const HalfedgeMesh& mesh, const Eigen::VectorXd& bend, Index h);

}  // namespace lsgp
