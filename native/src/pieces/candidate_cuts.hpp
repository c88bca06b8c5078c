// SPDX-License-Identifier: GPL-3.0-or-later
// Paths along which a surface may be cut in place of some of its cuts.
#pragma once

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The cuts and paths between them: for every two stretches of the cuts, and of the boundaries that these reach, whose
// regions meet, the cheapest path through the two regions (Mehlhorn 1988). On both halfedges.
PerHalfedge<char> find_candidate_cuts(const MetricMesh& surface, const CutGraph& cut_graph);

}  // namespace lsgp
