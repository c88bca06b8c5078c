// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic forms minimized under linear equations.
#pragma once

#include <Eigen/SparseCore>

namespace lsgp {

template <typename Scalar>
struct ConstrainedMinimum {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> x;            // (n)
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> multipliers;  // (r)  form x + rows^H multipliers = right_side
};

// Minimizes  x^H form x / 2 - Re(x^H right_side)  subject to  rows x = values.
// form: lower triangle, Hermitian positive definite, (n, n); rows: (r, n), dependent ones allowed where consistent.
// Consistent equations are satisfied to rounding; the caller checks whether they may contradict each other.
// Throws SolverFailure.
template <typename Scalar>
ConstrainedMinimum<Scalar> minimize_under(const Eigen::SparseMatrix<Scalar>& form,
                                          const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>& right_side,
                                          const Eigen::SparseMatrix<Scalar, Eigen::RowMajor>& rows,
                                          const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>& values);

}  // namespace lsgp
