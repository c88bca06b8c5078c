// SPDX-License-Identifier: GPL-3.0-or-later
// Relocates cones whose curvature is fixed, as in seamless layouts.
#pragma once

#include "base/array.hpp"
#include "placement/cone_search.hpp"

namespace lsgp {

// Moves cone after cone to the site where its curvature makes the variance of the log scale least; the first `kept`
// stay.  curvature: of the sites, both of two cones together. Returns whether any was moved.
bool relocate(const PlacementProblem& problem, const ConeSearch& search, int kept, const Eigen::VectorXd& curvature,
              Array<int>& sites);

}  // namespace lsgp
