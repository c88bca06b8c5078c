// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of coarsely modeled round surfaces, which bend as much as creases do: rings of a torus with six or eight
// sides.
#pragma once

#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// The angle between the normals of the triangles at each edge, radians, 0 on borders, (3m).
Eigen::VectorXd bends(const HalfedgeMesh& mesh);

// Whether the surface goes on bending on both sides of an inner edge as it does there: alike, and after faces of about
// one width.  bend: as of `bends`.
bool is_round(const HalfedgeMesh& mesh, const Eigen::VectorXd& bend, Index h);

// Whether half of the curvature inside is at vertices where the surface bends mostly at edges beside which, on one side
// at least, it goes on bending so: that of coarse balls, tori and capsules, unlike that of boxes and prisms.
bool has_round_shape(const MetricMesh& surface);

}  // namespace lsgp
