// SPDX-License-Identifier: GPL-3.0-or-later
// Cones of seamless layouts with texture directions.
#pragma once

#include <optional>

#include "placement/component_placement.hpp"

namespace lsgp {

// Cones only where the texture cannot follow the directions without bending, such as around the bottom of a vase, and
// none in a sleeve. directions: (m, 3) of the component's triangles. usual: cones placed without regard to them.
// None if the texture is no nearer to the directions, or at the cost of too much stretch.
std::optional<PlacedCones> place_beside_directions(const PlacementTask& task, const Positions& directions,
                                                   const PlacementOptions& options, const PlacedCones& usual,
                                                   ProgressMonitor& monitor);

// The usual cones with automatic angles chosen for strokes. None if directions are not strokes, or what that gains is
// not worth its stretch.
std::optional<PlacedCones> turn_toward_strokes(const PlacementTask& task, const Positions& directions,
                                               const PlacementOptions& options, const PlacedCones& usual,
                                               ProgressMonitor& monitor);

}  // namespace lsgp
