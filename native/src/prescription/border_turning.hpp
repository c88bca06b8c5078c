// SPDX-License-Identifier: GPL-3.0-or-later
// How much borders turn in all: as prescribed, as rounded, and once around holes that close without a cut.
#pragma once

#include "prescription/curvature.hpp"

namespace lsgp {

// The turning of a hole that closes without a cut, the surface on the left of its border, radians.
constexpr double once_around_a_hole = -2 * M_PI;

// Shifts the log scale, which is 0 along held borders, by constants along them that make them turn so, and says which
// holes need no cut. Throws LOOP_TURNING with the component's own vertex numbers.
void prescribe_turning(const LogScale& scale, const ComponentCones& cones, Curvature& curvature);

}  // namespace lsgp
