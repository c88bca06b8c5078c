// SPDX-License-Identifier: GPL-3.0-or-later
// The Jacobian of every triangle: prescribed by a metric, or measured on a map.
#pragma once

#include <Eigen/Core>

#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"
#include "systems/poisson_system.hpp"

namespace lsgp {

// The Jacobians of the flat metric: e^{y + i phi}, and no shear.
Jacobians prescribed_jacobians(const HalfedgeMesh& mesh, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames);
Jacobians measure_jacobians(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                            const Eigen::VectorXcd& position);

}  // namespace lsgp
