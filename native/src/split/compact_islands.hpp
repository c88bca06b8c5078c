// SPDX-License-Identifier: GPL-3.0-or-later
// Additional cuts with which the islands of a layout fill a square better.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/face_graph.hpp"
#include "split/island_division.hpp"

namespace lsgp {

// Cuts islands that are far from convex, or long compared with the square, if the area saved outweighs the additional
// cut length and islands; sharp edges are preferred. The parts do not move, so transitions are unchanged, and those
// across the additional cuts are the identity.
// surface: its open edges, besides the cuts. Returns whether any was cut.
bool compact_islands(const OpenedSurface& surface, const SharedSquare& square, ComponentMap& map);

}  // namespace lsgp
