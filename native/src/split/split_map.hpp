// SPDX-License-Identifier: GPL-3.0-or-later
// Splits a component's map where it overlaps itself.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/face_graph.hpp"

namespace lsgp {

// Exchanges the cuts for others (recut.hpp), unless some are kept, straight or pinned, adds cuts (split_overlaps.hpp)
// and merges the parts across others (merge_islands.hpp) until no island overlaps itself. Transitions change only by
// the motions of the parts. Flipped triangles necessarily overlap their neighbours and are ignored.
// surface: its open edges, besides the cuts.  kept: halfedges that may not be closed.
// Returns whether anything changed.
bool split_map(const OpenedSurface& surface, const PerHalfedge<char>& kept, ProgressMonitor& monitor,
               ComponentMap& map);

}  // namespace lsgp
