// SPDX-License-Identifier: GPL-3.0-or-later
// Components of which no map was found, cut open until they need none.
#pragma once

#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// The map; or one in which the components that it leaves out end at so many of their edges that none of their vertices
// is inside, and unfold without cones and stretch whatever they are, if it leaves fewer triangles out and has no
// further defects. Pieces go on across the flattest edges.  Throws CANCELLED.
Made with_unfolded_parts(const Made& made, const MapOptions& options, Objective& objective, const Progress& progress);

}  // namespace lsgp
