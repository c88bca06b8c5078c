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
Jacobians measure_jacobians(const MetricMesh& surface, const CutMesh& cut_mesh, const Eigen::VectorXcd& position);

// What to fit for every triangle's error to count relative to the scale of its target: if scales differ much, large
// triangles dominate the plain fit.
class RelativeFit {
 public:
  RelativeFit(const CutSurface& surface, Jacobians jacobians);

  CutSurface surface() const { return {{surface_.mesh, weighted_}, surface_.cut_graph, surface_.cut_mesh}; }
  const Jacobians& jacobians() const { return jacobians_; }

 private:
  const CutSurface surface_;
  Jacobians jacobians_;
  Geometry weighted_;
};

// The L2 stretch of a map without flips.
double l2_stretch(const Geometry& geometry, const Jacobians& jacobians);

}  // namespace lsgp
