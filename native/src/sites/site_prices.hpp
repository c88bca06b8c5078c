// SPDX-License-Identifier: GPL-3.0-or-later
// The price of a cone at a site: every cone needs a cut that reaches it.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "sites/cone_sites.hpp"

namespace lsgp {

// From 0 at sites that cuts reach cheaply to 1 at those that are hardest to reach, (sites), for both cones of a site
// together; smaller if the costs of cuts differ less, and 0 if cuts have no costs.
Eigen::VectorXd site_prices(const MetricMesh& surface, const Array<Site>& sites);

}  // namespace lsgp
