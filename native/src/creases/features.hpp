// SPDX-License-Identifier: GPL-3.0-or-later
// The creases of a hard surface, along which a texture or a grid of quads is to run.
#pragma once

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// Marks both halfedges of the edges at which the surface bends by 40 degrees or more; none if less than four fifths of
// its curvature are at their ends, as on a soft model.
PerHalfedge<char> find_features(const MetricMesh& surface);

}  // namespace lsgp
