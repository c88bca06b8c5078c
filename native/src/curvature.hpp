// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature prescription (the paper's section 5): how much angle every cone keeps.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cut_mesh.hpp"
#include "geometry.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/options.hpp"
#include "solvers/cholesky.hpp"
#include "topology.hpp"

namespace lsgp {

// The log scale y of the metric with given cone curvatures: L y = kappa - K, so y = y_K + sum of kappa_c G_c.
// One factorization; one more back-substitution for every cone.  On a boundary y = 0, so its curvature is free;
// a closed surface has y up to a constant and needs sum kappa = 2 pi chi.
class LogScale {
 public:
  LogScale(const HalfedgeMesh& mesh, const Geometry& geometry);

  void add_cones(const std::vector<Index>& vertices);  // inside vertices, none twice
  Index cone_count() const { return static_cast<Index>(cones_.size()); }
  const std::vector<Index>& cones() const { return cones_; }

  // y at every vertex (n), shifted to area-weighted mean 0.
  Eigen::VectorXd evaluate(const Eigen::VectorXd& cone_curvature) const;

  // Solves L y = right side, (n), under the same conditions; the sum of the right side is 0 on a closed surface.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;

  // The cone curvatures for which y is 0 (closed: constant) at all cones (Ben-Chen et al. 2008).
  Eigen::VectorXd harmonic_curvature() const;

  // The minimum of log mean e^{2y} + log mean e^{-2y} (area-weighted; the logarithm of the squared L2 stretch of the
  // map) over low <= kappa <= high from a feasible start: convex, Newton's method with a quadratic program a step.
  Eigen::VectorXd least_distortion_curvature(const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                             Eigen::VectorXd start) const;

  double predicted_l2(const Eigen::VectorXd& log_scale) const;

 private:
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right_sides) const;  // (n, k)

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  std::vector<Index> row_of_vertex_;
  std::optional<Cholesky<double>> factor_;
  Eigen::VectorXd weight_;         // (n) share of the area
  Eigen::VectorXd without_cones_;  // (n) y_K
  std::vector<Index> cones_;
  Eigen::MatrixXd green_;  // (n, k) G_c
};

// What a component's map has to realise.
struct Curvature {
  Eigen::VectorXd at_vertex;  // (n) imposed: cones theirs, 0 inside, what comes out on a boundary
  Eigen::VectorXd log_scale;  // (n) area-weighted mean 0
  double predicted_l2 = 1;
};

// Cones of one component, inside vertices only, with the angles (radians) the caller fixed.
struct ComponentCones {
  std::vector<Index> vertices;
  std::vector<std::optional<double>> angles;
};

// cut_graph, cut_mesh: used by the straightness rule.  Throws TOO_FEW_CONES, CONE_ANGLE_RANGE, GAUSS_BONNET with the
// component's own vertex numbers.
Curvature prescribe(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                    const CutMesh& cut_mesh, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings);

// The number of triangles around an inside vertex.
int valence(const HalfedgeMesh& mesh, Index vertex);

}  // namespace lsgp
