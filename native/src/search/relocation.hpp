// SPDX-License-Identifier: GPL-3.0-or-later
// Relocates cones whose curvature is fixed, as in seamless layouts.
#pragma once

#include "base/array.hpp"
#include "search/cone_search.hpp"

namespace lsgp {

// Moves each cone in turn to the site where its curvature minimizes the variance of the log scale and the mean price;
// the first `kept` are fixed.  curvature: of the sites, both of two cones together. Returns whether any was moved.
bool relocate(const PlacementProblem& problem, const HalfedgeMesh& mesh, int kept, const Eigen::VectorXd& curvature,
              Array<int>& sites);

}  // namespace lsgp
