// SPDX-License-Identifier: GPL-3.0-or-later
#include "untangle.hpp"

#include <array>
#include <vector>

#include "distortion.hpp"
#include "relaxation.hpp"
#include "transitions.hpp"

namespace lsgp {

namespace {

constexpr std::array<int, 3> neighbourhoods{2, 5, 10};  // rings of vertices around flipped triangles
constexpr double hopeless_share = 0.02;                 // of the triangles flipped: not a place is tangled but the map
constexpr int barrier_steps = 3;

}  // namespace

Eigen::VectorXcd untangle(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                          const CutMesh& cut_mesh, const Eigen::VectorXd& rotation, const Curvature& curvature,
                          const std::vector<char>& fixed, const Eigen::VectorXcd& position) {
  const Eigen::VectorXcd motion = motion_of_copies(mesh, cut_graph, cut_mesh, rotation);
  const auto check = [&](const Eigen::VectorXcd& tried) {
    return check_map(mesh, at_corners(cut_mesh, tried), curvature.at_vertex, curvature.is_free);
  };
  const Validity initial = check(position);
  Eigen::VectorXcd best = position;
  std::size_t fewest = initial.defects();
  const bool hopeless = static_cast<double>(initial.flipped.size()) > hopeless_share * mesh.triangle_count();
  for (const int rings : neighbourhoods) {
    if (fewest == 0 || hopeless) break;
    std::vector<char> marked = mark_around(mesh, initial.flipped, rings);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const bool is_cone = mesh.loop_of_vertex[v] == none && curvature.at_vertex[v] != 0;
      if (fixed[v] || is_cone) marked[v] = 0;
    }
    Freedom freedom = free_vertices(mesh, cut_mesh, motion, marked);
    if (freedom.displacement.unknown_count == 0) continue;
    Eigen::VectorXcd tried = position;
    Relaxation relaxation(mesh, geometry, cut_mesh, curvature.log_scale, std::move(freedom), tried);
    try {
      if (relaxation.unfold()) relaxation.smooth(conformal_barrier, barrier_steps);
    } catch (const Error&) {
      continue;  // what cannot be factored cannot be repaired, but it is still a map
    }
    const std::size_t left = check(tried).defects();
    if (left < fewest) {
      fewest = left;
      best = std::move(tried);
    }
  }
  return best;
}

}  // namespace lsgp
