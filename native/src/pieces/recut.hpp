// SPDX-License-Identifier: GPL-3.0-or-later
// Other cuts for the same cones, with which a layout overlaps itself less.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// Exchanges cuts of a map for others that connect the same cones, a key-path exchange at a time: a piece is detached
// along a new cut, moves rigidly by the transition of an old one, and is attached there. Overlap is measured on a
// raster from the boundaries of the pieces. Returns maps with less overlap whose cuts cost at most 1.25 times as much,
// in several compromises, the most promising first; empty if there are none. surface: cuts are sought where they are
// cheap on it.  costs: the same surface, with costs that count, each in turn.  map: without marked seams, with
// transitions. All its cuts may be closed.
Array<ComponentMap> recut(const MetricMesh& surface, const Array<MetricMesh>& costs, const ComponentMap& map);

}  // namespace lsgp
