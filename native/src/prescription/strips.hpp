// SPDX-License-Identifier: GPL-3.0-or-later
// Tubes that unfold into straight strips.
#pragma once

#include "mesh/geometry.hpp"

namespace lsgp {

// Whether a tube between two boundaries is predicted to have hardly more L2 stretch if neither of them turns than where
// they turn with least distortion: its girth is about the same all along, as that of a pipe is and that of a horn is
// not. Bends are stretched alike in both.
bool may_be_straight(const MetricMesh& tube);

}  // namespace lsgp
