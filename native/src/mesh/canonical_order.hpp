// SPDX-License-Identifier: GPL-3.0-or-later
// The order of a connected mesh's triangles by its shape, whatever its numbering.
#pragma once

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// For each triangle the halfedge that it begins with, in breadth-first order from the vertex farthest from the middle
// and the longest edge there; each triangle begins with the edge that the search came across. Of what is as far and as
// long as rounding can tell, that from which the search meets what is farther out first; of what is alike all over,
// that which is the farthest from a center, then by coordinates. So whatever goes by this order breaks its ties by the
// shape.
// center: of what the mesh is a part of.
Array<Index> order_by_shape(const HalfedgeMesh& mesh, const Eigen::RowVector3d& center);

}  // namespace lsgp
