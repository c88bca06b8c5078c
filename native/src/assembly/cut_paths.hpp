// SPDX-License-Identifier: GPL-3.0-or-later
// The cuts of a finished map as paths.
#pragma once

#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Fills in the paths and their kinds from the other fields.
void trace_cut_paths(const Surface& surface, Result& result);

}  // namespace lsgp
