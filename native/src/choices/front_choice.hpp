// SPDX-License-Identifier: GPL-3.0-or-later
// Whether what the front sees becomes a piece of its own.
#pragma once

#include "choices/symmetry_choice.hpp"
#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// At which edges a surface may end around what its front sees; none where nothing may be cut but seams, with marked
// seams, given cones, directions, borders of a shape of their own, and in seamless layouts, whose cuts do not show.
// progress: without time of its own.
VertexPairs outline_for(const Surface& surface, const GivenCones& given, const MapOptions& options,
                        const Progress& progress);

// The map, or one with the front in one piece, if it costs less. Neither the front nor what is behind it takes cones,
// so that no cut leads into it: only where the map is stretched no more than the target then, or than the other one. On
// other components cones stay.
Made best_of_front(const Made& usual, const VertexPairs& outline, double target, Objective& objective,
                   const Progress& progress);

}  // namespace lsgp
