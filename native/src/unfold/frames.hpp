// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of triangles in a flat metric (the paper's sections 4.2 and 6): integrated, read across cuts, rotated.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "mesh/geometry.hpp"
#include "solvers/cholesky.hpp"

namespace lsgp {

// The rotation of every triangle's frame in the flat metric e^{2y}: the connection
//   phi_g = phi_f + theta_f - theta_g - w (y_j - y_i)
// across the edge from i to j with f on its left and g on its right (theta: its direction in each frame), integrated
// along a spanning tree of the triangles that crosses no cut.
class FrameTree {
 public:
  FrameTree(const MetricMesh& surface, const CutGraph& cut_graph);

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
Eigen::VectorXd read_rotations(const MetricMesh& surface, const CutGraph& cut_graph, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames);

// Rotates the frames so that the rotations of the cuts change, in the smoothest way: a harmonic form.
class HarmonicOneForm {
 public:
  HarmonicOneForm(const MetricMesh& surface, const CutGraph& cut_graph);

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

// The direction of boundary edges in the metric (halfedges with the surface on their left), radians.
Eigen::VectorXd metric_directions(const MetricMesh& surface, const Eigen::VectorXd& log_scale,
                                  const Eigen::VectorXd& frames, const Array<Index>& edges);

}  // namespace lsgp
