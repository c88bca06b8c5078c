// SPDX-License-Identifier: GPL-3.0-or-later
// Cones with which the creases of a hard surface can run along the lines of a square lattice.
#pragma once

#include <optional>
#include <utility>

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The angles of a patch between features, in quarter turns.
struct PatchAngles {
  PerVertex<Index> at_border;                // (n) the patch's angle at a vertex of its boundary, 0 inside
  Array<std::pair<Index, Index>> curvature;  // of cones inside: vertex and quarter turns
};

// Angles between the features at their corners, rounded to quarter turns, and the fewest cones inside that
// Gauss-Bonnet requires, where the log scale of a map with straight sides varies least (Fogg, Armstrong and Robinson
// 2015). None if the boundary admits no such angles.
std::optional<PatchAngles> round_patch(const MetricMesh& patch);

}  // namespace lsgp
