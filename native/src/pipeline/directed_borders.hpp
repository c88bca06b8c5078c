// SPDX-License-Identifier: GPL-3.0-or-later
// Boundaries that were to turn so that a seamless layout follows directions, compared with free ones by their maps.
#pragma once

#include "pipeline/component_map.hpp"

namespace lsgp {

// Whether courses of a texture are straight enough, or straighter than before.
// missed, before: mean angles to the directions, modulo rotations of the lattice, radians.
bool straightens_courses(double missed, double before);

// What a map has.
struct DirectedMap {
  double l2, missed;  // mean angle to the directions, radians
};

// Whether a map whose angles are chosen for strokes is worth its stretch.
bool is_worth_strokes(const DirectedMap& toward, const DirectedMap& usual);

// Frees the boundaries of a task that `let_borders_run_along` has prescribed, unless that straightens courses at little
// stretch. What a direction in space leaves on a beveled rim turns around it, as if the surface were a sleeve there.
// Throws CANCELLED and OUT_OF_MEMORY.
void free_stretched_borders(const MetricMesh& surface, ProgressMonitor& monitor, ComponentTask& task);

}  // namespace lsgp
