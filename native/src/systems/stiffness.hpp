// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that is stiff around its cones.
#pragma once

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The geometry whose Dirichlet form weights triangles by the inverse square of their distance to the nearest cone. A
// harmonic displacement has a pole where a single vertex is moved; with these weights the surroundings of a cone move
// with it, and the displacement fades over its whole neighborhood.
Geometry stiffen_around(const MetricMesh& surface, const Array<Index>& cones);

}  // namespace lsgp
