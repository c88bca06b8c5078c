// SPDX-License-Identifier: GPL-3.0-or-later
// A component's map split where it lies on itself.
#pragma once

#include <vector>

#include "component_map.hpp"

namespace lsgp {

// Opens a map along further cuts (split_overlaps.hpp) and joins its parts across others (join_parts.hpp) until none
// overlaps itself.  Transitions stay what they were but for how the parts moved.  Flipped triangles lie on their
// neighbours by nature and are let be.
// open: (3m) halfedges at which the layout ends, besides the cuts.  kept: (3m) those that may not be closed.
// Returns whether anything changed.
bool split_map(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open,
               const std::vector<char>& kept, Monitor& monitor, ComponentMap& map);

}  // namespace lsgp
