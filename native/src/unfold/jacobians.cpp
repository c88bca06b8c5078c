// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/jacobians.hpp"

#include <cmath>
#include <utility>

#include "base/thread_team.hpp"
#include "systems/quadratic_forms.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

Jacobians prescribed_jacobians(const HalfedgeMesh& mesh, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames) {
  Jacobians out{Eigen::VectorXcd(frames.size()), Eigen::VectorXcd::Zero(frames.size())};
  const Eigen::VectorXd share = (log_scale / 3).array().exp();  // contribution of a corner to its triangle's scale
  for_each_at_once(mesh.triangle_count(), [&](Index f) {
    const double scale = share[mesh.triangles(f, 0)] * share[mesh.triangles(f, 1)] * share[mesh.triangles(f, 2)];
    out.f_z[f] = std::polar(scale, frames[f]);
  });
  return out;
}

RelativeFit::RelativeFit(const CutSurface& surface, Jacobians jacobians)
    : surface_(surface), jacobians_(std::move(jacobians)) {
  constexpr double widest_range = 1e8;  // of the weights, so that the form can be factored
  Eigen::VectorXd weight = jacobians_.f_z.cwiseAbs2().cwiseInverse();
  weight = weight.cwiseMin(widest_range * weight.minCoeff());
  weighted_ = with_weights(surface.geometry, weight);
  jacobians_.f_z = jacobians_.f_z.cwiseProduct(weight);
  jacobians_.f_zbar = jacobians_.f_zbar.cwiseProduct(weight);
}

Jacobians measure_jacobians(const MetricMesh& surface, const CutMesh& cut_mesh, const Eigen::VectorXcd& position) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  Jacobians out{Eigen::VectorXcd::Zero(mesh.triangle_count()), Eigen::VectorXcd::Zero(mesh.triangle_count())};
  for_each_at_once(mesh.triangle_count(), [&](Index f) {
    for (Index corner = 3 * f; corner < 3 * f + 3; ++corner) {
      const Complex edge = edge_vector(geometry, next(corner)) / (4 * geometry.area[f]);
      const Complex z = position[cut_mesh.copy_of_corner[corner]];
      out.f_z[f] += Complex(0, -1) * std::conj(edge) * z;
      out.f_zbar[f] += Complex(0, 1) * edge * z;
    }
  });
  return out;
}

double l2_stretch(const Geometry& geometry, const Jacobians& jacobians) {
  L2Stretch stretch;
  for (Eigen::Index f = 0; f < jacobians.f_z.size(); ++f) {
    const double p = std::norm(jacobians.f_z[f]), q = std::norm(jacobians.f_zbar[f]);
    stretch.add(geometry.area[f], geometry.area[f] * (p - q), (p + q) / ((p - q) * (p - q)));
  }
  return stretch.value();
}

}  // namespace lsgp
