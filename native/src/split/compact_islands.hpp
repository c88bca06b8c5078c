// SPDX-License-Identifier: GPL-3.0-or-later
// Additional cuts after which the islands of a layout fill a square better.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/face_graph.hpp"
#include "split/island_division.hpp"

namespace lsgp {

// Cuts islands that are far from convex, or long beside the square, where that saves more of its area than it costs in
// cut length and islands; rather along sharp edges. The parts keep their places, so the transitions stay what they are,
// and those across the further cuts are the identity.
// surface: where the layout ends, besides the cuts.
void compact_islands(const OpenedSurface& surface, const SharedSquare& square, ComponentMap& map);

}  // namespace lsgp
