// SPDX-License-Identifier: GPL-3.0-or-later
// Additional cuts with which the islands of a layout fill a square better.
#pragma once

#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "division/island_division.hpp"
#include "mesh/mirror.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// Cuts islands that are far from convex, or long compared with the square, if the area saved outweighs the additional
// cut length and islands; sharp edges are preferred. The parts do not move, so transitions are unchanged, and those
// across the additional cuts are the identity.
// Islands that lie on both sides of a mirror plane are cut alike on both.
// surface: its open edges, besides the cuts.  mirroring: of the mesh, or empty. Returns whether any was cut.
bool compact_islands(const OpenedSurface& surface, const Mirroring& mirroring, const SharedSquare& square,
                     ComponentMap& map);

}  // namespace lsgp
