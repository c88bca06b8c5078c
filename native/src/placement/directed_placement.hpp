// SPDX-License-Identifier: GPL-3.0-or-later
// Cones of seamless layouts whose texture is to run along directions.
#pragma once

#include <optional>

#include "placement/component_placement.hpp"

namespace lsgp {

// Cones only where the texture cannot run straight along the directions anyway, such as around the bottom of a vase,
// and none in a sleeve. directions: (m, 3) of the component's triangles. usual: cones placed without regard to them.
// None where that brings the texture no nearer to the directions, or takes too much stretch.
std::optional<PlacedCones> place_beside_directions(const PlacementTask& task, const Positions& directions,
                                                   const PlacementOptions& options, const PlacedCones& usual,
                                                   ProgressMonitor& monitor);

}  // namespace lsgp
