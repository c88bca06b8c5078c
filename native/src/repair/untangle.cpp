// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/untangle.hpp"

#include <array>
#include <cmath>

#include "repair/newton.hpp"
#include "transitions/transitions.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr std::array<int, 3> neighborhoods{2, 5, 10};  // rings of vertices around flipped triangles
constexpr double hopeless_share = 0.005;               // of the triangles flipped: the defect is global, not local
// Iterations of Newton's method, which needs few for small defects, and of smoothing afterward.
struct Steps {
  int unfolding, smoothing;
};
constexpr Steps local_steps{30, 3}, global_steps{25, 10};
constexpr double smoothing_decrease = 1e-3;  // of the energy in a step of smoothing

// The rotation of a whole map against frames.
double turn_against(const MetricMesh& surface, const CutMesh& cut_mesh, const Eigen::VectorXd& frames,
                    const Eigen::VectorXcd& position) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Jacobians jacobians = measure_jacobians(surface, cut_mesh, position);
  Complex along = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    along += geometry.area[f] * jacobians.f_z[f] * std::polar(1.0, -frames[f]);
  }
  return std::arg(along);
}

// Flipped triangles, and those around vertices with wrong angle sums.
Array<Index> defective_triangles(const HalfedgeMesh& mesh, const Validity& validity) {
  Array<Index> out = validity.flipped;
  for (const Index v : validity.wrong_angle_sums) mesh.for_each_outgoing(v, [&](Index h) { out.push_back(h / 3); });
  return out;
}

}  // namespace

Eigen::VectorXcd untangle(const CutSurface& surface, const MapTarget& target, const UntangleOptions& options,
                          const StepHook& before_step, const HeldMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutMesh& cut_mesh = surface.cut_mesh;
  const ParallelTransport& connection = target.connection;
  const Curvature& curvature = target.curvature;
  const Eigen::VectorXcd motion = motion_of_copies(mesh, surface.cut_graph, cut_mesh, connection.rotation);
  const auto check = [&, &mesh = mesh, &cut_mesh = cut_mesh](const Eigen::VectorXcd& tried) {
    return check_map(mesh, at_corners(cut_mesh, tried), curvature.at_vertex, curvature.is_free);
  };
  Eigen::VectorXcd best = map.position;
  Validity left = check(best);
  const Eigen::VectorXd frames =
      connection.frames.array() + turn_against(surface, cut_mesh, connection.frames, map.position);
  const auto try_out = [&](DegreesOfFreedom freedom, Kind energy, const Steps& most) {
    if (left.defects() == 0 || freedom.displacement.unknown_count == 0) return;
    Eigen::VectorXcd tried = best;
    NewtonMinimizer newton(surface, {curvature.log_scale, frames}, std::move(freedom), before_step, tried);
    if (newton.unfold(energy, most.unfolding)) {
      newton.smooth(Kind::conformal_barrier, most.smoothing, smoothing_decrease);
    }
    Validity after = check(tried);
    if (after.defects() >= left.defects()) return;
    left = std::move(after);
    best = std::move(tried);
  };
  const auto free_around = [&, &mesh = mesh, &cut_mesh = cut_mesh](int rings) {
    PerVertex<char> marked = mark_around(mesh, defective_triangles(mesh, left), rings);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const bool is_cone = mesh.loop_of_vertex[v] == none && curvature.at_vertex[v] != 0;
      if (map.fixed[v] || is_cone) marked[v] = 0;
    }
    return free_vertices(mesh, cut_mesh, motion, marked);
  };
  const Kind second = options.first == Kind::foldover_free ? Kind::framed_foldover_free : Kind::foldover_free;
  if (static_cast<double>(left.flipped.size()) <= hopeless_share * mesh.triangle_count()) {
    for (const int rings : neighborhoods) {
      for (const Kind energy : {options.first, second}) try_out(free_around(rings), energy, local_steps);
    }
  }
  if (options.effort == Effort::local) return best;
  // The framed energy controls angles; the plain one works even if no map can follow the frames.
  for (const Kind energy : {Kind::framed_foldover_free, Kind::foldover_free}) {
    try_out(free_all(mesh, cut_mesh, connection.reduction, map.fixed), energy, global_steps);
  }
  return best;
}

}  // namespace lsgp
