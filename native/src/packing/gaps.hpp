// SPDX-License-Identifier: GPL-3.0-or-later
// Islands of a layout that meet.
#pragma once

#include "base/array.hpp"
#include "packing/outline.hpp"

namespace lsgp {

// The first two outlines of which one meets the other, or lies in it; {-1, -1}: none do.
std::pair<Index, Index> overlapping_pair(const Array<Outline>& outlines);

}  // namespace lsgp
