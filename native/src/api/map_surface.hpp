// SPDX-License-Identifier: GPL-3.0-or-later
// `parameterize` for maps of which not everything is asked.
#pragma once

#include "assembly/assembly.hpp"
#include "lsgp/options.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct MapRequest {
  const Cones& cones;
  const Options& options;
  const Pins& pins;
  OverlapSearch search;
};

Result map_surface(const Surface& surface, const MapRequest& request, const Progress& progress);

}  // namespace lsgp
