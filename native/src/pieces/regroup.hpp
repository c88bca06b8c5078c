// SPDX-License-Identifier: GPL-3.0-or-later
// Other islands for the same map, fewer of them and with cheaper cuts.
#pragma once

#include <optional>

#include "mesh/per_element.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

enum class Regrouping : char {
  direct,   // every step improves the islands
  detours,  // pieces also make room for others first
};

// Moves pieces of a map between its islands and within them, across cuts beside which they then lie without overlap.
// That never makes more islands. surface: other cuts are sought where they are cheap on it.  factor: what cuts cost, as
// from relative_cut_factors.  map: with transitions, without marked seams or pins. No island overlaps itself, of the
// result neither. Its required cuts are those that one island would need. None if the islands stay as they are.
std::optional<ComponentMap> regroup(const MetricMesh& surface, const PerHalfedge<double>& factor, Regrouping steps,
                                    const ComponentMap& map);

}  // namespace lsgp
