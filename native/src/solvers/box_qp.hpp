// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense convex quadratic programs with box constraints.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <optional>

#include "base/array.hpp"
#include "solvers/dense_cholesky.hpp"

namespace lsgp {

// Minimizes  gradient . d + d . hessian d / 2  over  low <= d <= high  and, with keep_sum, sum d = 0.
// A primal active-set method: every iterate is feasible and the objective never rises. The active set is kept from one
// program to the next, and the factorization for as long as the set does not change.
// All but the smallest programs change the sides of many variables at once (block principal pivoting, Judice and Pires
// 1994) and fall back on the active-set method where that does not converge, large ones on a limited number of its
// steps.
class BoxProgram {
 public:
  explicit BoxProgram(bool keep_sum) : keep_sum_(keep_sum) {}
  // hessian: (k, k) symmetric positive definite, full.
  void set_hessian(Eigen::MatrixXd hessian);
  // d = 0 must lie within the bounds.
  Eigen::VectorXd minimize(const Eigen::VectorXd& gradient, const Eigen::VectorXd& low, const Eigen::VectorXd& high);

 private:
  enum class Side : char { free, low, high };
  struct Step {
    Eigen::VectorXd direction;  // (k) zero at the bounded variables
    double multiplier = 0;      // of the sum
  };

  std::optional<Eigen::VectorXd> pivot_blocks(const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                                              const Eigen::VectorXd& high);
  bool factorize_block(const Array<int>& free);
  // The step to the minimum over the free variables, the others held.
  Step step_to_minimum(const Eigen::VectorXd& slope, const Array<int>& free);
  Array<int> free_variables() const;
  void factorize(const Array<int>& free);

  const bool keep_sum_;
  Eigen::MatrixXd hessian_;
  Array<Side> side_;  // (k)
  Array<int> free_;   // those that are factored
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> factor_;
  // Of block pivoting.
  Array<int> block_free_;
  std::optional<DenseCholesky<double>> block_;
  Eigen::VectorXd block_ones_;  // the block's inverse times ones
};

// The point low <= x <= high of the given sum that differs from the wanted point by a common shift, up to the bounds;
// the nearest one if no point has that sum.
Eigen::VectorXd nearest_with_sum(const Eigen::VectorXd& low, const Eigen::VectorXd& high, const Eigen::VectorXd& wanted,
                                 double sum);

}  // namespace lsgp
