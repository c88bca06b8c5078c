// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_task.hpp"

#include <complex>

#include "repair/low_stretch.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr double mendable_share = 0.1;  // of the triangles, flipped, that are repaired
constexpr Index few = 8;                // that are always
constexpr int unfolding_steps = 16;
constexpr int relaxing_steps = 30;
constexpr double least_decrease = 1e-3;  // of the energy, for which a further step is taken

Validity validity_of(const FeatureTask& task, const Eigen::VectorXcd& position) {
  const CutSurface& surface = task.surface;
  return check_map(surface.mesh, at_corners(surface.cut_mesh, position), task.curvature.at_vertex,
                   task.curvature.is_free);
}

}  // namespace

PerVertex<char> FeatureTask::mark_cones() const {
  const HalfedgeMesh& mesh = surface.mesh;
  PerVertex<char> out(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    out[v] = mesh.loop_of_vertex[v] == none && curvature.at_vertex[v] != 0;
  }
  return out;
}

bool FeatureTask::is_upright(Index triangle, const Eigen::VectorXcd& position) const {
  const auto corner = [&](int c) { return position[surface.cut_mesh.copy_of_corner[3 * triangle + c]]; };
  return std::imag(std::conj(corner(1) - corner(0)) * (corner(2) - corner(0))) > 0;
}

bool FeatureTask::flips_at_most(double share, const Eigen::VectorXcd& position) const {
  const HalfedgeMesh& mesh = surface.mesh;
  Index flipped = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) flipped += is_upright(f, position) ? 0 : 1;
  return flipped <= few || flipped <= share * mesh.triangle_count();
}

bool FeatureTask::is_valid(const Eigen::VectorXcd& position) const {
  return validity_of(*this, position).defects() == 0;
}

Array<Index> FeatureTask::defects_of(const Eigen::VectorXcd& position) const {
  const Validity validity = validity_of(*this, position);
  Array<Index> out = validity.wrong_angle_sums;
  for (const Index f : validity.flipped) {
    for (int c = 0; c < 3; ++c) out.push_back(surface.mesh.triangles(f, c));
  }
  sort_unique(out);
  return out;
}

bool FeatureTask::minimize(const DegreesOfFreedom& freedom, Eigen::VectorXcd& position) const {
  if (!flips_at_most(mendable_share, position)) return false;
  relax(freedom, Eigen::VectorXd::Ones(surface.mesh.triangle_count()), position);
  return is_valid(position);
}

void FeatureTask::relax(const DegreesOfFreedom& freedom, const Eigen::VectorXd& weights,
                        Eigen::VectorXcd& position) const {
  const Eigen::VectorXd frames = Eigen::VectorXd::Zero(weights.size());
  const Eigen::VectorXd rest = scale_at_rest(surface, curvature, 1, position);
  NewtonMinimizer newton(surface, {rest, frames}, freedom, before_step, position);
  newton.weigh(weights);
  // Wrong angle sums stay wrong without flips.
  if (newton.unfold(Kind::foldover_free, unfolding_steps) && is_valid(position)) {
    newton.smooth(Kind::symmetric_dirichlet, relaxing_steps, least_decrease);
  }
}

}  // namespace lsgp
