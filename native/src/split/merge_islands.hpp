// SPDX-License-Identifier: GPL-3.0-or-later
// Merges parts of a layout across its cuts where they do not overlap.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/cut_apart.hpp"

namespace lsgp {

// Puts a layout that is divided into parts, each of which lies on itself nowhere, together to fewer: parts move across
// a common cut, which closes, where that leaves them beside each other. Longer cuts are closed first; where parts
// would hang on a few edges alone, they stay apart. map: its cuts and transitions.  part: (m) of every triangle.  kept:
// (3m) edges that stay open.  open: (3m) halfedges at which parts end; loses those that are closed. Returns how the
// parts move.
Array<Motion> merge_islands(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map,
                            const Array<Index>& part, const Array<char>& kept, Array<char>& open);

}  // namespace lsgp
