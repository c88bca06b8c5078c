// SPDX-License-Identifier: GPL-3.0-or-later
// Islands of a layout that meet, or nearly do.
#pragma once

#include "base/array.hpp"
#include "packing/outline.hpp"

namespace lsgp {

// The first two outlines of which one meets the other, or lies in it; {-1, -1}: none do.
std::pair<Index, Index> overlapping_pair(const Array<Outline>& outlines);

// Whether none of them meets another one, or lies in it, or is nearer to it than the gap.
bool keep_gap(const Array<Outline>& outlines, double gap);

// The same of two, without a tree.
bool are_apart(const Outline& one, const Outline& other, double gap);

}  // namespace lsgp
