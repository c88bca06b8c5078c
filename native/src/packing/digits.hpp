// SPDX-License-Identifier: GPL-3.0-or-later
// Whether numbers hold the shapes of islands where they are packed.
#pragma once

#include "lsgp/packing.hpp"
#include "packing/layout_search.hpp"

namespace lsgp {

// Throws NoRoom where islands would get to coordinates so large that numbers there are too far apart for their shapes;
// it says which margin, or area, is small or near enough. Islands that are too small beside the others in any case do
// not count.
void require_digits(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options);

}  // namespace lsgp
