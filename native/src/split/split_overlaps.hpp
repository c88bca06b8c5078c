// SPDX-License-Identifier: GPL-3.0-or-later
// Additional cuts that remove the overlaps of a layout with itself.
#pragma once

#include <functional>

#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "division/minimum_cut.hpp"
#include "plane/overlaps.hpp"

namespace lsgp {

// Finds edges to open so that no two triangles of one part overlap: minimum cuts between overlapping sets, few and
// short, preferably along marked seams and sharp edges. The parts do not move, so the transitions are unchanged.
// Returns a halfedge of every edge.
Array<Index> split_overlaps(const OpenedSurface& surface, const Array<Overlap>& overlaps, CutCost rule,
                            const std::function<void()>& before_cut);

}  // namespace lsgp
