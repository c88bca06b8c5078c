// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

// These triangles by themselves, with what is marked on them; vertices keep their numbers.
Surface part_of(const Surface& surface, const std::vector<Index>& triangles);

}  // namespace lsgp
