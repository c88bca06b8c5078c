// SPDX-License-Identifier: GPL-3.0-or-later
// Merges parts of a layout across its cuts where they do not overlap.
#pragma once

#include "base/array.hpp"
#include "division/part_borders.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// Merges overlap-free parts across shared cuts, longest first, wherever the union stays overlap-free. Parts whose
// shared cut is only a few edges long are not merged.
// map: its cuts and transitions.  kept: edges that stay open.  parts: closed halfedges are cleared from `open`,
// and `motion` gets the motion of each part.
void merge_islands(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts);

}  // namespace lsgp
