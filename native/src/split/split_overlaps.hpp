// SPDX-License-Identifier: GPL-3.0-or-later
// Additional cuts that remove the overlaps of a layout with itself.
#pragma once

#include <functional>

#include "base/array.hpp"
#include "plane/overlaps.hpp"
#include "split/face_graph.hpp"
#include "split/minimum_cut.hpp"

namespace lsgp {

// Finds edges to open so that no two triangles of one part overlap: minimum cuts between what lies on what, so few and
// short, and rather along marked seams and sharp edges. The parts keep their places, so the transitions stay what they
// are. Returns a halfedge of every edge.
Array<Index> split_overlaps(const OpenedSurface& surface, const Array<Overlap>& overlaps, CutCost rule,
                            const std::function<void()>& before_cut);

}  // namespace lsgp
