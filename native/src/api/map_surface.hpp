// SPDX-License-Identifier: GPL-3.0-or-later
// `parameterize` for maps of which not everything is asked.
#pragma once

#include "assembly/assembly.hpp"
#include "lsgp/options.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

Result map_surface(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                   OverlapSearch search, const Progress& progress);

}  // namespace lsgp
