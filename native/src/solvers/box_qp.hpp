// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense convex quadratic programs between bounds.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <optional>
#include <vector>

namespace lsgp {

// Minimises  gradient . d + d . hessian d / 2  over  low <= d <= high  and, with keep_sum, sum d = 0.
// A primal active-set method: every iterate is feasible and the objective never rises.  Which variables are at their
// bounds is remembered from one program to the next, and a factorization is kept while that does not change.
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

  // The step to the minimum over the free variables, the others held.
  Step step_to_minimum(const Eigen::VectorXd& slope, const std::vector<int>& free);
  std::vector<int> free_variables() const;
  void factorize(const std::vector<int>& free);

  const bool keep_sum_;
  Eigen::MatrixXd hessian_;
  std::vector<Side> side_;  // (k)
  std::vector<int> free_;   // those that are factored
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> factor_;
};

// The point low <= x <= high with the given sum that differs from the wanted one by a common shift, as far as the
// bounds let it; the nearest one where no point has that sum.
Eigen::VectorXd nearest_with_sum(const Eigen::VectorXd& low, const Eigen::VectorXd& high, const Eigen::VectorXd& wanted,
                                 double sum);

}  // namespace lsgp
