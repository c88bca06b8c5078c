// SPDX-License-Identifier: GPL-3.0-or-later
// Unfolding with edges in exact directions.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "systems/poisson_system.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// The positions u + iv of all copies: the fit to Jacobians (PoissonSystem::fit) with exactly aligned boundary edges:
// each of `edges` has the given direction, radians. A real problem of twice the size.
Eigen::VectorXcd unfold_aligned(const CutSurface& surface, const Reduction& reduction, const Jacobians& jacobians,
                                const Array<Index>& edges, const Eigen::VectorXd& directions);

}  // namespace lsgp
