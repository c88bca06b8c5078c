// SPDX-License-Identifier: GPL-3.0-or-later
// Straight cuts across rings.
#pragma once

#include <optional>

#include "cut/cut_graph.hpp"

namespace lsgp {

// The cheapest edge path from one boundary of a ring to the other that goes straight ahead at every vertex, as the rows
// of a mesh of quads do. None where there is no such path.
std::optional<CutGraph> cut_across(const MetricMesh& ring);

// The cheapest two closed edge paths on a torus that go straight ahead at every vertex and have one vertex in common,
// as a row of quads and a ring of them. None where there are no such paths.
std::optional<CutGraph> cut_around(const MetricMesh& torus);

}  // namespace lsgp
