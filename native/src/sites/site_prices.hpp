// SPDX-License-Identifier: GPL-3.0-or-later
// What it costs to have a cone somewhere: every cone forces a cut that gets there.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "sites/cone_sites.hpp"

namespace lsgp {

// From 0 at sites that cuts get to cheaply to 1 at those hardest to get to, (sites), of both cones of a site together;
// the less, the less the costs of cuts differ, and 0 where cuts have none.
Eigen::VectorXd site_prices(const MetricMesh& surface, const Array<Site>& sites);

}  // namespace lsgp
