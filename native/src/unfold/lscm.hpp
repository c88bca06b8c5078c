// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares conformal maps, for comparison.
#pragma once

#include <Eigen/Core>

#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The positions u + iv of all copies: the least squares conformal map of the opened surface with two pinned copies, no
// transitions (Levy et al. 2002). The pins are the lowest-numbered copy on the open boundary and the one half the
// boundary's edges away.
Eigen::VectorXcd unfold_lscm(const MetricMesh& surface, const CutMesh& cut_mesh);

}  // namespace lsgp
