// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense convex quadratic programs between bounds.
#pragma once

#include <Eigen/Core>

namespace lsgp {

// Minimises  gradient . d + d . hessian d / 2  over  low <= d <= high  and, with keep_sum, sum d = 0.
// hessian: (k, k) symmetric positive definite, full; d = 0 must lie within the bounds.
// A primal active-set method: every iterate is feasible and the objective never rises.
Eigen::VectorXd minimize_in_box(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                const Eigen::VectorXd& low, const Eigen::VectorXd& high, bool keep_sum);

// The point low <= x <= high with the given sum that differs from the wanted one by a common shift, as far as the
// bounds let it; the nearest one where no point has that sum.
Eigen::VectorXd nearest_with_sum(const Eigen::VectorXd& low, const Eigen::VectorXd& high, const Eigen::VectorXd& wanted,
                                 double sum);

}  // namespace lsgp
