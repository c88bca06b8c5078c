// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that lie on others share their map.
#pragma once

#include <utility>

#include "base/array.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Gives such triangles the coordinates of those that they lie on; they are skipped with these.
// duplicates: as in Topology.
void share_maps(const Surface& surface, const Array<std::pair<Index, Index>>& duplicates, Result& result);

}  // namespace lsgp
