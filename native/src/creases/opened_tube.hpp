// SPDX-License-Identifier: GPL-3.0-or-later
// Tubes that are open along a line already, as along a marked seam.
#pragma once

#include <array>
#include <optional>

#include "mesh/geometry.hpp"

namespace lsgp {

// The least and the largest girth of a disk of quads in rows and columns whose rows begin and end at the same places,
// in the same order: a tube, open along one line. None of other surfaces.
std::optional<std::array<double, 2>> girths_of_opened_tube(const MetricMesh& surface);

}  // namespace lsgp
