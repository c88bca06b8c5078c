// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that is stiff around its cones.
#pragma once

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The geometry whose Dirichlet form weighs triangles the more the nearer they are to a cone, by the inverse square of
// the distance. A harmonic displacement has a pole where a single vertex is moved; with these weights all that
// surrounds a cone moves with it, and the displacement fades over its whole neighbourhood.
Geometry stiffen_around(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Index>& cones);

}  // namespace lsgp
