// SPDX-License-Identifier: GPL-3.0-or-later
// Costs of cuts at vertices, by which a surface with fewer of these gets costs of its own edges.
#pragma once

#include <Eigen/Core>

#include "lsgp/surface.hpp"

namespace lsgp {

// (n) The mean over the edges at each vertex; empty without costs.
Eigen::VectorXd costs_at_vertices(const Surface& surface);

// Makes all edges of the surface its edges, at the mean costs of their ends.  cost: (n).
void take_costs(const Eigen::VectorXd& cost, Surface& surface);

}  // namespace lsgp
