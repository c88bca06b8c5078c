// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/low_stretch.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/large_surface.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr int newton_steps = 30;
constexpr double newton_decrease = 1e-5;  // of the energy in a step
// On large surfaces, whose steps take long: on 70,000 triangles the last three of seven steps lower the energy by less
// than a ten-thousandth together.
constexpr double decrease_on_large = 2e-4;
constexpr double least_weight = 1e-3;  // of the mean, so that no vertex is without any

}  // namespace

Eigen::VectorXd importance_of_triangles(const MetricMesh& surface, const Eigen::VectorXd& importance) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  Eigen::VectorXd out = Eigen::VectorXd::Ones(mesh.triangle_count());
  if (importance.size() == 0) return out;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    out[f] = 0;
    for (int c = 0; c < 3; ++c) out[f] += importance[mesh.triangles(f, c)] / 3;
  }
  const double mean = out.dot(geometry.area) / geometry.total_area;
  if (!(mean > 0)) return Eigen::VectorXd::Ones(out.size());
  return (out / mean).cwiseMax(least_weight);
}

void relax_stretch(NewtonMinimizer& newton) {
  const double decrease = newton.triangle_count() < least_large ? newton_decrease : decrease_on_large;
  newton.smooth(Kind::symmetric_dirichlet, newton_steps, decrease);
}

Eigen::VectorXd scale_at_rest(const CutSurface& surface, const Curvature& curvature, double stretch,
                              const Eigen::VectorXcd& position) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Eigen::VectorXd rest = (1 - stretch) * curvature.log_scale;
  const Jacobians jacobians = measure_jacobians(surface, surface.cut_mesh, position);
  double area = 0, rest_area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    double mean = 0;
    for (int c = 0; c < 3; ++c) mean += rest[mesh.triangles(f, c)] / 3;
    area += geometry.area[f] * (std::norm(jacobians.f_z[f]) - std::norm(jacobians.f_zbar[f]));
    rest_area += geometry.area[f] * std::exp(2 * mean);
  }
  return rest.array() + std::log(area / rest_area) / 2;
}

Eigen::VectorXcd lower_stretch(const CutSurface& surface, const MapTarget& target, const StretchOptions& options,
                               const StepHook& before_step, const HeldMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutMesh& cut_mesh = surface.cut_mesh;
  const ParallelTransport& connection = target.connection;
  const Curvature& curvature = target.curvature;
  const Eigen::VectorXd rest = scale_at_rest(surface, curvature, options.stretch, map.position);
  Eigen::VectorXcd best = map.position;
  // One linear step brings a map without fixed vertices close: frames are kept, lengths are the target's.
  if (std::find(map.fixed.begin(), map.fixed.end(), 1) == map.fixed.end()) {
    before_step();
    Eigen::VectorXcd fitted =
        PoissonSystem(surface, connection.reduction).fit(prescribed_jacobians(mesh, rest, connection.frames));
    if (fitted.allFinite() &&
        check_map(mesh, at_corners(cut_mesh, fitted), curvature.at_vertex, curvature.is_free).defects() == 0) {
      best = std::move(fitted);
    }
  }
  NewtonMinimizer newton(surface, {rest, connection.frames}, free_all(mesh, cut_mesh, connection.reduction, map.fixed),
                         before_step, best);
  newton.weigh(importance_of_triangles(surface, options.importance));
  relax_stretch(newton);
  return best;
}

}  // namespace lsgp
