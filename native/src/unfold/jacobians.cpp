// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/jacobians.hpp"

#include <cmath>

#include "base/thread_team.hpp"

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

Jacobians measure_jacobians(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                            const Eigen::VectorXcd& position) {
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

}  // namespace lsgp
