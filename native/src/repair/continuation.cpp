// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/continuation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lsgp/errors.hpp"
#include "unfold/aligned.hpp"
#include "unfold/distortion.hpp"
#include "unfold/frames.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr double first_step = 0.25, shortest_step = 0.005;
constexpr int most_steps = 40;
constexpr int barrier_steps = 2;  // so that shear does not pile up on the way

// The Jacobians of a map, transformed like the metric and its frames.
Jacobians carry_over(const CutSurface& surface, const Waypoint& from, const Waypoint& to,
                     const Eigen::VectorXcd& position) {
  Jacobians out = measure_jacobians(surface, surface.cut_mesh, position);
  const Eigen::VectorXd grown = to.curvature.log_scale - from.curvature.log_scale;
  const Eigen::VectorXd turned = to.connection.frames - from.connection.frames;
  for (Index f = 0; f < surface.mesh.triangle_count(); ++f) {
    double scale = 0;
    for (int c = 0; c < 3; ++c) scale += grown[surface.mesh.triangles(f, c)] / 3;
    const Complex change = std::polar(std::exp(scale), turned[f]);
    out.f_z[f] *= change;
    out.f_zbar[f] *= change;
  }
  return out;
}

// None if weights differ too much to be factored.
std::optional<Eigen::VectorXcd> fit_at(const CutSurface& surface, const Waypoint& next, const Array<Index>& aligned,
                                       const Jacobians& jacobians) try {
  const RelativeFit fit(surface, jacobians);
  if (aligned.empty()) return PoissonSystem(fit.surface(), next.connection.reduction).fit(fit.jacobians());
  const Eigen::VectorXd directions =
      metric_directions(surface, next.curvature.log_scale, next.connection.frames, aligned);
  return unfold_aligned(fit.surface(), next.connection.reduction, fit.jacobians(), aligned, directions);
} catch (const Error& error) {
  if (error.code() != Code::solver_failed) throw;
  return std::nullopt;
}

bool is_valid(const CutSurface& surface, const Curvature& curvature, const Eigen::VectorXcd& position) {
  return position.allFinite() &&
         check_map(surface.mesh, at_corners(surface.cut_mesh, position), curvature.at_vertex, curvature.is_free)
                 .defects() == 0;
}

}  // namespace

Path path_between(const Curvature& begin, const ParallelTransportChoice& connections, const Curvature& end) {
  const auto at = [&begin, &connections, &end](double share) {
    Waypoint out{end, {}};
    if (share < 1) {
      out.curvature.at_vertex = (1 - share) * begin.at_vertex + share * end.at_vertex;
      out.curvature.log_scale = (1 - share) * begin.log_scale + share * end.log_scale;
    }
    out.connection = connections.at(share, out.curvature);
    return out;
  };
  return {at, {}};
}

Continuation follow(const CutSurface& surface, const Path& path, Effort effort, const StepHook& before_step,
                    const HeldMap& map) {
  Continuation out{0, path.at(0), map.position};
  double step = first_step;
  for (int tried = 0; out.reached < 1 && step > shortest_step && tried < most_steps; ++tried) {
    before_step();
    const double share = std::min(1.0, out.reached + step);
    Waypoint next = path.at(share);
    std::optional<Eigen::VectorXcd> fitted =
        fit_at(surface, next, path.aligned, carry_over(surface, out.at, next, out.position));
    if (!fitted) {
      step /= 2;
      continue;
    }
    Eigen::VectorXcd moved = std::move(*fitted);
    if (!is_valid(surface, next.curvature, moved)) {
      moved = untangle(surface, {next.connection, next.curvature}, {effort, Kind::framed_foldover_free}, before_step,
                       {moved, map.fixed});
    }
    if (!is_valid(surface, next.curvature, moved)) {
      step /= 2;
      continue;
    }
    NewtonMinimizer(surface, {next.curvature.log_scale, next.connection.frames},
                    free_all(surface.mesh, surface.cut_mesh, next.connection.reduction, map.fixed), before_step, moved)
        .smooth(Kind::conformal_barrier, barrier_steps);
    out = {share, std::move(next), std::move(moved)};
    step *= 1.5;
  }
  return out;
}

}  // namespace lsgp
