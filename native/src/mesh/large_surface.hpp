// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lsgp/surface.hpp"

namespace lsgp {

// Surfaces with so many triangles are large: effort for the last bit of quality takes too long there.
constexpr Index least_large = 30000;

}  // namespace lsgp
