// SPDX-License-Identifier: GPL-3.0-or-later
#include "untangle.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "distortion.hpp"
#include "relaxation.hpp"
#include "transitions.hpp"
#include "unfold.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr std::array<int, 3> neighbourhoods{2, 5, 10};  // rings of vertices around flipped triangles
constexpr double hopeless_share = 0.005;                // of the triangles flipped: not a place is tangled but the map
constexpr int barrier_steps = 3;
// Of Newton's method, which takes a few where it succeeds.
constexpr int local_steps = 30;
constexpr int global_steps = 15;

// How a map is turned as a whole against frames.
double turn_against(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                    const Eigen::VectorXd& frames, const Eigen::VectorXcd& position) {
  const Jacobians jacobians = measure_jacobians(mesh, geometry, cut_mesh, position);
  Complex along = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    along += geometry.area[f] * jacobians.f_z[f] * std::polar(1.0, -frames[f]);
  }
  return std::arg(along);
}

// Those that are flipped, and those around vertices whose angles are wrong.
std::vector<Index> defective_triangles(const HalfedgeMesh& mesh, const Validity& validity) {
  std::vector<Index> out = validity.flipped;
  for (const Index v : validity.wrong_angle_sums) mesh.for_each_outgoing(v, [&](Index h) { out.push_back(h / 3); });
  return out;
}

}  // namespace

Eigen::VectorXcd untangle(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                          const CutMesh& cut_mesh, const Eigen::VectorXd& rotation, const Curvature& curvature,
                          const Eigen::VectorXd& frames, const std::vector<char>& fixed, Effort effort, Kind first,
                          const Eigen::VectorXcd& position) {
  const Eigen::VectorXcd motion = motion_of_copies(mesh, cut_graph, cut_mesh, rotation);
  const auto check = [&](const Eigen::VectorXcd& tried) {
    return check_map(mesh, at_corners(cut_mesh, tried), curvature.at_vertex, curvature.is_free);
  };
  Eigen::VectorXcd best = position;
  Validity left = check(best);
  const Eigen::VectorXd turned = frames.array() + turn_against(mesh, geometry, cut_mesh, frames, position);
  const auto try_out = [&](std::vector<char> marked, Kind energy, int most_steps) {
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const bool is_cone = mesh.loop_of_vertex[v] == none && curvature.at_vertex[v] != 0;
      if (fixed[v] || is_cone) marked[v] = 0;
    }
    Freedom freedom = free_vertices(mesh, cut_mesh, motion, marked);
    if (freedom.displacement.unknown_count == 0) return;
    Eigen::VectorXcd tried = best;
    Relaxation relaxation(mesh, geometry, cut_mesh, curvature.log_scale, turned, std::move(freedom), tried);
    try {
      if (relaxation.unfold(energy, most_steps)) relaxation.smooth(Kind::conformal_barrier, barrier_steps);
    } catch (const Error&) {
      return;  // what cannot be factored cannot be repaired, but it is still a map
    }
    Validity after = check(tried);
    if (after.defects() >= left.defects()) return;
    left = std::move(after);
    best = std::move(tried);
  };
  const bool hopeless = static_cast<double>(left.flipped.size()) > hopeless_share * mesh.triangle_count();
  if (hopeless) return best;
  const Kind second = first == Kind::foldover_free ? Kind::framed_foldover_free : Kind::foldover_free;
  for (const int rings : neighbourhoods) {
    for (const Kind energy : {first, second}) {
      if (left.defects() > 0) try_out(mark_around(mesh, defective_triangles(mesh, left), rings), energy, local_steps);
    }
  }
  if (left.defects() > 0 && effort == Effort::global) {
    try_out(std::vector<char>(mesh.vertex_count(), 1), Kind::framed_foldover_free, global_steps);
  }
  return best;
}

}  // namespace lsgp
