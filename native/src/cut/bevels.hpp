// SPDX-License-Identifier: GPL-3.0-or-later
// Creases that are rounded: narrow strips of faces between two faces that turn the surface within a short distance.
#pragma once

#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct Bevels {
  PerHalfedge<char> crease;    // both halfedges of edges along the middle of a bevel, or none at all
  PerVertex<char> is_rounded;  // vertices of the strips
};

// bend: (3m) radians between the normals at an edge. angle: least turn from one side of a bevel to the other, radians.
// There are none on a component of which they would be a large part.
Bevels find_bevels(const MetricMesh& surface, const Eigen::VectorXd& bend, double angle);

}  // namespace lsgp
