// SPDX-License-Identifier: GPL-3.0-or-later
// Merges parts of a layout across its cuts where they do not overlap.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/cut_apart.hpp"

namespace lsgp {

// The parts that a map is divided into.
struct MapParts {
  Array<char> open;      // (3m) halfedges at which they end, on both sides of an edge
  Array<Index> part;     // (m) of every triangle
  Array<Motion> motion;  // (parts) how each moves
};

// Puts a layout that is divided into parts, each of which lies on itself nowhere, together to fewer: parts move across
// a common cut, which closes, where that leaves them beside each other. Longer cuts are closed first; where parts
// would hang on a few edges alone, they stay apart. map: its cuts and transitions.  kept: (3m) edges that stay open.
// parts: loses open halfedges that are closed, and gets how it moves.
void merge_islands(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map, const Array<char>& kept,
                   MapParts& parts);

}  // namespace lsgp
