// SPDX-License-Identifier: GPL-3.0-or-later
// Splits a component's map where it overlaps itself.
#pragma once

#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "division/island_division.hpp"
#include "mesh/mirror.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// How a map may be split.
struct SplitTask {
  const PerHalfedge<char>& kept;  // halfedges that may not be closed
  const Mirroring& mirroring;     // islands are alike on both sides if it is not empty and that costs little
};

// Exchanges the cuts for others (recut.hpp), unless some are kept, straight or pinned, adds cuts (split_overlaps.hpp)
// and merges the parts across others (merge_islands.hpp) until no island overlaps itself. Transitions change only by
// the motions of the parts. Flipped triangles necessarily overlap their neighbors and are ignored.
// surface: its open edges, besides the cuts.
// Returns whether anything changed.
bool split_map(const OpenedSurface& surface, const SplitTask& task, ProgressMonitor& monitor, ComponentMap& map);

// Makes the islands of a map without overlaps alike on both sides again after some were cut further to fill a square,
// unless that costs too much or fills the square less.
void restore_symmetry(const OpenedSurface& surface, const SplitTask& task, const SharedSquare& square,
                      ComponentMap& map);

}  // namespace lsgp
