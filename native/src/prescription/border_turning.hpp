// SPDX-License-Identifier: GPL-3.0-or-later
// The total turning of boundaries: prescribed, rounded, and once around holes that close without a cut.
#pragma once

#include "prescription/curvature.hpp"

namespace lsgp {

// The turning of a hole that closes without a cut, the surface on the left of its boundary, radians.
constexpr double once_around_a_hole = -2 * M_PI;

// Adds constants along held boundaries to the log scale, which is 0 there, so that they turn accordingly, and returns
// the holes that need no cut. Throws LOOP_TURNING with the component's own vertex numbers.
void prescribe_turning(const LogScale& scale, const ComponentCones& cones, Curvature& curvature);

}  // namespace lsgp
