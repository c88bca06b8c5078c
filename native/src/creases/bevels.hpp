// SPDX-License-Identifier: GPL-3.0-or-later
// Creases that are rounded: narrow strips of faces between two faces that turn the surface within a short distance.
#pragma once

#include <optional>

#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct Bevels {
  PerHalfedge<char> edge;      // both halfedges of the edges of the strips' triangles, sharp ones excepted
  PerHalfedge<char> crease;    // those of them along the middle of a bevel
  PerVertex<char> is_rounded;  // vertices of the strips
};

// bend: (3m) radians between the normals at an edge. angle: least turn from one side of a bevel to the other, radians.
// None where there are no narrow strips, or where they are a large part of the component.
std::optional<Bevels> find_bevels(const MetricMesh& surface, const Eigen::VectorXd& bend, double angle);

}  // namespace lsgp
