// SPDX-License-Identifier: GPL-3.0-or-later
// `place_cones` with data kept from earlier calls on the surface.
#pragma once

#include "kept/kept_components.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct KnownSurface {
  const Surface& surface;
  KeptComponents& components;
};

// Keeps the systems of the placed cones whose maps were computed.
Placement place_cones_on(const KnownSurface& known, const Cones& existing, const PlacementOptions& options,
                         const Progress& progress);

}  // namespace lsgp
