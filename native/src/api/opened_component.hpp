// SPDX-License-Identifier: GPL-3.0-or-later
// The map of a component with seams that got no cones: it is opened along them.
#pragma once

#include "lsgp/placement.hpp"
#include "pipeline/components.hpp"
#include "placement/component_placement.hpp"

namespace lsgp {

// Whether cones that were placed leave the component to be opened along its seams.
bool is_opened(const Component& component, const PlacedCones& placed, const PlacementOptions& options);

// Predicts and, where it was measured, measures the map of the opened component instead.
void describe_opened(const Component& component, const PlacementOptions& options, ProgressMonitor& monitor,
                     PlacedCones& placed);

}  // namespace lsgp
