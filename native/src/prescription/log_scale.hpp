// SPDX-License-Identifier: GPL-3.0-or-later
// The log scale of a metric with prescribed curvatures (the paper's section 5), and the curvatures that suit it best.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "base/array.hpp"
#include "mesh/border.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"
#include "prescription/coarse_green.hpp"
#include "systems/laplace_solver.hpp"

namespace lsgp {

// The largest L2 stretch that is predicted: its square is a number.
constexpr double largest_l2 = 1e100;

// The log scale y of the metric with given curvatures: L y = kappa - K where y is not held at 0, so y is affine in the
// cone curvatures, y = y_0 + sum of kappa_c G_c. One factorization; one more back-substitution for every cone, if there
// are not so many that a few per step are cheaper, in directions from a coarse surface. Without cones it waits for the
// first use, since large surfaces may never need their own. With nothing held, y is known up to a constant,
// Gauss-Bonnet has to hold, and y is held at one vertex, a cone if any.
class LogScale {
 public:
  // cones: interior, distinct.  factor: if given, an existing one with the cones on its cuts.
  LogScale(const MetricMesh& surface, const BorderConditions& border, const Array<Index>& cones = {},
           const CutFactor* factor = nullptr);

  const MetricMesh& surface() const { return surface_; }
  const HalfedgeMesh& mesh() const { return surface_.mesh; }
  const Geometry& geometry() const { return surface_.geometry; }
  const BorderConditions& border() const { return border_; }

  void set_cones(const Array<Index>& vertices);  // distinct, not held; solves for those that are new
  Index cone_count() const { return static_cast<Index>(cones_.size()); }
  const Array<Index>& cones() const { return cones_; }
  bool balanced() const { return border_.balanced; }
  bool is_factored() const { return laplace_ != nullptr; }
  // The required sum of the cone curvatures when balanced.
  double required_sum() const { return 2 * M_PI * surface_.mesh.euler - border_.curvature.sum(); }

  // y at every vertex (n), shifted to area-weighted mean 0.
  Eigen::VectorXd evaluate(const Eigen::VectorXd& cone_curvature) const;
  // The same, unshifted: 0 where held.
  Eigen::VectorXd evaluate_held(const Eigen::VectorXd& cone_curvature) const;
  // The same with curvatures at any vertices, which need not be cones; one back-substitution.
  Eigen::VectorXd evaluate_held(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const;
  // Whether the effects of cones are known; there may be too many.
  bool has_effects() const { return !is_coarse_; }
  // The change of that per unit of a cone's curvature.
  auto effect(Index cone) const { return green().col(cone); }

  // Solves L y = right side, (n), where y is not held; the sum of the right side is 0 when balanced.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right_sides) const;  // (n, k)

  // The cone curvatures for which y is 0 (balanced: constant) at all cones (Ben-Chen et al. 2008).
  Eigen::VectorXd harmonic_curvature() const;

  // The minimum of log mean e^{2y} + log mean e^{-2y} (area-weighted; the logarithm of the squared L2 stretch of the
  // map) over low <= kappa <= high from a feasible start: convex, Newton's method with a quadratic program a step.
  Eigen::VectorXd least_distortion_curvature(const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                             Eigen::VectorXd start) const;

  // The L2 stretch of the map, (area-weighted mean e^{2y} mean e^{-2y})^{1/2}: with y at the midpoints of edges, which
  // is most accurate, and lumped at the vertices, which is faster and minimized by the prescription.
  double predicted_l2(const Eigen::VectorXd& log_scale) const;
  double lumped_l2(const Eigen::VectorXd& log_scale) const;

  // The area-weighted variance of y: constant + 2 gradient . kappa + kappa . hessian kappa.
  struct Variance {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
  };
  Variance variance() const;

 private:
  class Stretch;

  PerVertex<char> held_with(Index vertex) const;  // if balanced
  const LaplaceSolver& laplace() const;
  const Eigen::VectorXd& without_cones() const;
  const Eigen::MatrixXd& green() const;
  const CoarseGreen& coarse_green() const;
  // Sum of kappa_c G_c, and the inner product of every G_c with values at vertices (n), (k).
  Eigen::VectorXd combine(const Eigen::VectorXd& cone_curvature) const;
  Eigen::VectorXd products(const Eigen::VectorXd& values) const;

  const MetricMesh surface_;
  BorderConditions border_;
  Array<Index> cones_;
  Eigen::VectorXd weight_;  // (n) share of the area
  bool is_coarse_ = false;  // whether Green's functions on a coarse surface are used
  // Made on first use, if not with cones at once.
  mutable Eigen::MatrixXd green_;  // (n, k) G_c
  mutable std::unique_ptr<CoarseGreen> coarse_green_;
  mutable std::unique_ptr<LaplaceSolver> laplace_;
  mutable Eigen::VectorXd without_cones_;  // (n) y_0
};

}  // namespace lsgp
