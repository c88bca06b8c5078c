// SPDX-License-Identifier: GPL-3.0-or-later
// Splits a component's map where it overlaps itself.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/face_graph.hpp"

namespace lsgp {

// Opens a map along further cuts (split_overlaps.hpp) and joins its parts across others (merge_islands.hpp) until none
// overlaps itself. Transitions stay what they were but for how the parts moved. Flipped triangles lie on their
// neighbours by nature and are let be.
// surface: where the layout ends, besides the cuts.  kept: (3m) halfedges that may not be closed.
// Returns whether anything changed.
bool split_map(const OpenedSurface& surface, const Array<char>& kept, ProgressMonitor& monitor, ComponentMap& map);

}  // namespace lsgp
