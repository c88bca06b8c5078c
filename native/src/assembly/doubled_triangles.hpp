// SPDX-License-Identifier: GPL-3.0-or-later
// Duplicate triangles share the map of the original.
#pragma once

#include <utility>

#include "base/array.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Gives duplicates the coordinates of the originals; they are skipped with these.
// duplicates: as in Topology.
void share_maps(const Surface& surface, const Array<std::pair<Index, Index>>& duplicates, Result& result);

}  // namespace lsgp
