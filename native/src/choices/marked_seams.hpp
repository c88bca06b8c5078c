// SPDX-License-Identifier: GPL-3.0-or-later
// Marked seams before cones are placed: charts that are good without cones get none, the others few further cuts.
#pragma once

#include "choices/symmetry_choice.hpp"
#include "lsgp/completed_cones.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// What a press makes of a surface with marked seams.
struct AlongSeams {
  Surface surface;      // its seams include further cuts
  GivenCones given;     // with the triangles that get none
  MapOptions options;   // of its maps
  VertexPairs further;  // the cuts besides the marked seams that leave charts as disks
};

// Which charts that marked seams bound get no cones, and the cuts of those that are no disks.
//
// A chart is good if its map along the seams alone has no flipped triangles and is stretched no more than the target.
// One that is not is cut where it is no disk, if it is good then; otherwise it gets cones, as it does without seams.
// Charts of components with given cones, and of seamless layouts, across whose seams the texture runs on, are good if
// all of their component are. With SeamMode::exact no chart gets cones or cuts.
// Throws what `measure_charts` throws; WRONG_PARAMETER if cones are to be placed with SeamMode::exact.
AlongSeams along_seams(const Surface& surface, const GivenCones& given, const MapOptions& options,
                       const Progress& progress);

// Makes further cuts in the result of such a surface none of the marked seams.
void tell_further_cuts(const VertexPairs& further, Result& result);

}  // namespace lsgp
