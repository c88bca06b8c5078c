// SPDX-License-Identifier: GPL-3.0-or-later
// The order of many numbers.
#pragma once

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// The places of numbers by size, the least first; equal ones in their order. Radix sort.
// numbers: not negative, without NaN.
Array<Index> radix_order(const Array<double>& numbers);

}  // namespace lsgp
