// SPDX-License-Identifier: GPL-3.0-or-later
// Unfolding into the plane (the paper's sections 4.2 and 6).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "cut/transitions.hpp"
#include "mesh/geometry.hpp"
#include "solvers/cholesky.hpp"
#include "systems/poisson_system.hpp"

namespace lsgp {

// The rotation of every triangle's frame in the flat metric e^{2y}: the connection
//   phi_g = phi_f + theta_f - theta_g - w (y_j - y_i)
// across the edge from i to j with f on its left and g on its right (theta: its direction in each frame), integrated
// along a spanning tree of the triangles that crosses no cut.
class FrameTree {
 public:
  FrameTree(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph);

  // Radians, (m).
  Eigen::VectorXd integrate(const Eigen::VectorXd& log_scale) const;

 private:
  struct Step {
    Index from, to;    // triangles
    Index tail, head;  // of the edge between them, `from` on its left
    double turn;       // theta_from - theta_to
    double weight;
  };
  const Index triangle_count_;
  Array<Step> steps_;  // outwards from the first triangle
};

// The rotation of every cut that those frames imply, radians modulo 2 pi: curvature determines it except for the loops
// about handles, where this is the rotation with least distortion.
Eigen::VectorXd read_rotations(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                               const Eigen::VectorXd& log_scale, const Eigen::VectorXd& frames);

// Rotates the frames so that the rotations of the cuts change, in the smoothest way: a harmonic form.
class HarmonicOneForm {
 public:
  HarmonicOneForm(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph);

  // The increment of the frames, (m).  change: (cuts) of the rotations, radians; it closes around every node.
  Eigen::VectorXd spread(const Eigen::VectorXd& change) const;

  // The Gram matrix, in the Dirichlet energy, of the twists by several changes, (cuts, k).
  Eigen::MatrixXd energy(const Eigen::MatrixXd& changes) const;

 private:
  // Across the cuts: from the triangle on the left to the one on the right.
  template <typename Visit>
  void for_each_crossing(Visit visit) const;
  double weight(Index h) const;

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const CutGraph& cut_graph_;
  std::optional<Cholesky<double>> factor_;
};

// The Jacobians of the flat metric: e^{y + i phi}, and no shear.
Jacobians prescribed_jacobians(const HalfedgeMesh& mesh, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames);
Jacobians measure_jacobians(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                            const Eigen::VectorXcd& position);

// What to fit for every triangle's error to count relative to the scale of its target: if scales differ much, large
// triangles dominate the plain fit.
class RelativeFit {
 public:
  RelativeFit(const CutSurface& surface, Jacobians jacobians);

  CutSurface surface() const { return {surface_.mesh, weighted_, surface_.cut_graph, surface_.cut_mesh}; }
  const Jacobians& jacobians() const { return jacobians_; }

 private:
  const CutSurface surface_;
  Jacobians jacobians_;
  Geometry weighted_;
};

// The L2 stretch of a map without flips.
double l2_stretch(const Geometry& geometry, const Jacobians& jacobians);

// Each returns the positions u + iv of all copies.

// The direction of boundary edges in the metric (halfedges with the surface on their left), radians.
Eigen::VectorXd metric_directions(const HalfedgeMesh& mesh, const Geometry& geometry, const Eigen::VectorXd& log_scale,
                                  const Eigen::VectorXd& frames, const Array<Index>& edges);

// The fit to Jacobians (PoissonSystem::fit) with exactly aligned boundary edges: each of `edges` has the given
// direction, radians. A real problem of twice the size.
Eigen::VectorXcd unfold_aligned(const CutSurface& surface, const Reduction& reduction, const Jacobians& jacobians,
                                const Array<Index>& edges, const Eigen::VectorXd& directions);

// The map of least conformal energy at a given Dirichlet energy (Mullen et al. 2008, with a norm that transitions
// leave invariant). Solved on the cut if the surface has a factor, sparse otherwise. Rounding does not choose its
// rotation: the position farthest from the origin is on the positive u axis.
Eigen::VectorXcd unfold_spectral(const CutSurface& surface, const Reduction& reduction);

// Least squares conformal map of the opened surface with two pinned copies, no transitions (Levy et al. 2002).
// The pins are the lowest-numbered copy on the open boundary and the one half the boundary's edges away.
Eigen::VectorXcd unfold_lscm(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh);

}  // namespace lsgp
