// SPDX-License-Identifier: GPL-3.0-or-later
// Seamless layouts (the paper's section 8): all but small components on one grid, exact in the precision that is
// stored.
#pragma once

#include <vector>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "pipeline/component_map.hpp"
#include "seamless/seamless_component.hpp"

namespace lsgp {

// Throws WRONG_PARAMETER.
void require_valid(const Seamless& seamless, const Options& options, const Pins& pins);

// Throws SEAMLESS_IMPOSSIBLE for a map that has flipped triangles or wrong angles.
void require_quantizable(const HalfedgeMesh& mesh, const ComponentMap& map);

// Rounds the cuts of all maps to one grid, those of small components to finer ones, and places the maps side by side in
// texture coordinates, with cut vertices at binary fractions, so that transitions hold exactly in float32 (on
// triangular lattices, whose points are irrational, to its last digit). Maps are recomputed if cones are merged.
// unit_scale: from the components' positions to the caller's. Components that have no layout on any grid, or one whose
// cuts are too short for single precision, are removed from `components` and reported as COMPONENT_SKIPPED. If all
// components fail, the first error is rethrown, in the caller's numbering: GRID_TOO_COARSE, SEAMLESS_IMPOSSIBLE.
SeamlessReport make_seamless(const Options& options, double unit_scale, Array<SeamlessComponent>& components,
                             std::vector<Finding>& findings, ProgressMonitor& monitor);

}  // namespace lsgp
