// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/component_unfold.hpp"

#include <cmath>

#include "mesh/border.hpp"
#include "systems/poisson_system.hpp"
#include "unfold/aligned.hpp"
#include "unfold/frames.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// A boundary without corners is one straight line along its own translation, but the discrete metric determines the
// angle between two such boundaries only to the mesh's resolution. Its direction is therefore taken from the map
// without straight boundaries, whose translations are consistent.
// natural: (3m) that map.
void turn_cornerless_borders(const HalfedgeMesh& mesh, const Array<Index>& corners, const Eigen::VectorXcd& natural,
                             const Array<Index>& edges, Eigen::VectorXd& directions) {
  const std::size_t loop_count = mesh.boundary_loops.size();
  PerLoop<char> has_corner(loop_count, 0);
  for (const Index v : corners) {
    if (mesh.loop_of_vertex[v] != none) has_corner[mesh.loop_of_vertex[v]] = 1;
  }
  PerLoop<Complex> along(loop_count, 0.0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Complex edge = natural[next(edges[i])] - natural[edges[i]];
    along[mesh.loop_of_vertex[mesh.origin(edges[i])]] +=
        std::polar(1.0, -directions[static_cast<Eigen::Index>(i)]) * edge;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index loop = mesh.loop_of_vertex[mesh.origin(edges[i])];
    if (!has_corner[loop]) directions[static_cast<Eigen::Index>(i)] += std::arg(along[loop]);
  }
}

Eigen::VectorXcd unfold_along_borders(const CutSurface& surface, const ComponentMap& map, const ComponentCones& cones,
                                      const ParallelTransport& connection, const Array<Index>& edges) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Eigen::VectorXd& log_scale = map.curvature.log_scale;
  Eigen::VectorXd directions = metric_directions(surface, log_scale, connection.frames, edges);
  const Jacobians jacobians = prescribed_jacobians(mesh, log_scale, connection.frames);
  if (cones.border == BorderMode::straight) {
    const Eigen::VectorXcd natural = PoissonSystem(surface, connection.reduction).fit(jacobians);
    turn_cornerless_borders(mesh, cones.vertices, at_corners(map.cut_mesh, natural), edges, directions);
  }
  return unfold_aligned(surface, connection.reduction, jacobians, edges, directions);
}

}  // namespace

// A surface with boundary has infinitely many conformal maps, so the spectral step would return an arbitrary one; the
// smallest eigenvector is only meaningful without cones (Mullen et al. 2008).
UnfoldMethod usable_unfold(const HalfedgeMesh& mesh, const ComponentCones& cones, UnfoldMethod asked,
                           std::vector<Finding>& findings) {
  const bool plain_disk =
      mesh.boundary_loops.size() == 1 && mesh.genus == 0 && cones.vertices.empty() && cones.border == BorderMode::free;
  if (asked == UnfoldMethod::poisson || mesh.closed() || plain_disk) return asked;
  findings.push_back(
      {Code::spectral_needs_closed,
       "The spectral unfolding is ill-posed on a surface with boundary and cones; the Poisson unfolding was "
       "used instead.",
       {}});
  return UnfoldMethod::poisson;
}

Array<Index> aligned_edges(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  return cones.border == BorderMode::straight ? straight_edges(mesh, cones.vertices)
                                              : corner_edges(mesh, cones.vertices);
}

Eigen::VectorXcd unfold_poisson(const CutSurface& surface, const ComponentMap& map, const ComponentCones& cones,
                                const ParallelTransport& connection) {
  const Array<Index> aligned = aligned_edges(surface.mesh, cones);
  if (!aligned.empty()) return unfold_along_borders(surface, map, cones, connection, aligned);
  return PoissonSystem(surface, connection.reduction)
      .fit(prescribed_jacobians(surface.mesh, map.curvature.log_scale, connection.frames));
}

Eigen::VectorXcd unfold_relatively(const CutSurface& surface, const Curvature& curvature,
                                   const ParallelTransport& connection) {
  const RelativeFit fit(surface, prescribed_jacobians(surface.mesh, curvature.log_scale, connection.frames));
  return PoissonSystem(fit.surface(), connection.reduction).fit(fit.jacobians());
}

}  // namespace lsgp
