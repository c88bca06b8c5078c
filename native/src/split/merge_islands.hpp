// SPDX-License-Identifier: GPL-3.0-or-later
// Merges parts of a layout across its cuts where they do not overlap.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "split/cut_apart.hpp"

namespace lsgp {

// A map divided into parts.
struct MapParts {
  Array<char> open;      // (3m) halfedges between parts, on both sides of an edge
  Array<Index> part;     // (m) of every triangle
  Array<Motion> motion;  // (parts)
};

// Merges overlap-free parts across shared cuts, longest first, wherever the union stays overlap-free. Parts whose
// shared cut is only a few edges long are not merged.
// map: its cuts and transitions.  kept: (3m) edges that stay open.  parts: closed halfedges are cleared from `open`,
// and `motion` gets the motion of each part.
void merge_islands(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map, const Array<char>& kept,
                   MapParts& parts);

}  // namespace lsgp
