// SPDX-License-Identifier: GPL-3.0-or-later
// The distances between islands of a layout, measured.
#pragma once

#include "base/array.hpp"
#include "packing/outline.hpp"

namespace lsgp {

// The least distance between segments of different outlines, or `reach` if that is less; 0 where segments cross.
double least_gap(const Array<Outline>& outlines, double reach);

// The first two outlines of which one meets the other, or lies in it; {-1, -1}: none do.
std::pair<Index, Index> overlapping_pair(const Array<Outline>& outlines);

}  // namespace lsgp
