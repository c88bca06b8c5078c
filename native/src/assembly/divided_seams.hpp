// SPDX-License-Identifier: GPL-3.0-or-later
// Seam residuals of components that were split into islands, which are moved independently.
#pragma once

#include "base/array.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

struct PlacedIslands {
  const PerTriangle<Index>& of_triangle;
  PerPart<double> turn;  // by which each was turned, radians
};

// Measures positions u + iv at the component's corners, (3m), against the imposed transitions and the rotations of the
// islands: its cuts, and the edges along which it was divided without a cut.
void check_divided_seams(const HalfedgeMesh& mesh, const PlacedIslands& islands, const CornerPositions& corners,
                         ComponentMap& map);

}  // namespace lsgp
