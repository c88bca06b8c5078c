// SPDX-License-Identifier: GPL-3.0-or-later
// How far the islands of a map are divided to fill the square.
#pragma once

#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// The map through the same cones with its islands divided as they were, further, or less: what costs least.
// usual: the map with these options. progress: without time of its own.  Throws CANCELLED.
Made best_division(const Made& usual, const MapOptions& options, Objective& objective, const Progress& progress);

}  // namespace lsgp
