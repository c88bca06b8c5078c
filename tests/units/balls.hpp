// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lsgp/surface.hpp"

namespace lsgp {

// A smooth ball of about so many triangles without symmetry.
Surface uneven_ball(Index triangles);

// Two surfaces that share nothing.
Surface merged(const Surface& one, const Surface& other);

}  // namespace lsgp
