// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/saddle_point.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <complex>

#include "solvers/failure.hpp"
#include "solvers/sparse_assembly.hpp"

namespace lsgp {

namespace {

constexpr double regularization = 1e-9;  // relative to the form; refinement removes its effect
constexpr int most_refinements = 30;
constexpr double refined = 1e-15;  // of the values' size

}  // namespace

template <typename Scalar>
ConstrainedMinimum<Scalar> minimize_under(const Eigen::SparseMatrix<Scalar>& form,
                                          const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>& right_side,
                                          const Eigen::SparseMatrix<Scalar, Eigen::RowMajor>& rows,
                                          const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>& values) {
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  const int n = static_cast<int>(form.rows()), r = static_cast<int>(rows.rows());
  LowerAssembly<Scalar> assembly(n + r, static_cast<std::size_t>(form.nonZeros() + rows.nonZeros() + r));
  double scale = 0;
  for (int column = 0; column < n; ++column) {
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(form, column); it; ++it) {
      assembly.add(static_cast<int>(it.row()), column, it.value());
      if (it.row() == column) scale += std::abs(it.value()) / n;
    }
  }
  for (int row = 0; row < r; ++row) {
    for (typename Eigen::SparseMatrix<Scalar, Eigen::RowMajor>::InnerIterator it(rows, row); it; ++it) {
      assembly.add(n + row, static_cast<int>(it.col()), it.value());
    }
    assembly.add(n + row, n + row, Scalar(-regularization / scale));
  }
  // Quasi-definite: a factorization with a diagonal exists in any order (Vanderbei 1995).
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Scalar>, Eigen::Lower> factor(assembly.build());
  if (factor.info() != Eigen::Success) throw SolverFailure(SolverFailure::Cause::dependent_constraints);

  // Refinement against the equations without regularization.
  Vector solution = Vector::Zero(n + r);
  const double size = std::max(right_side.norm() / scale, values.norm());
  for (int round = 0; round < most_refinements; ++round) {
    Vector residual(n + r);
    residual.head(n) = right_side - form.template selfadjointView<Eigen::Lower>() * solution.head(n) -
                       rows.adjoint() * solution.tail(r);
    residual.tail(r) = values - rows * solution.head(n);
    const Vector correction = factor.solve(residual);
    solution += correction;
    if (!(correction.head(n).norm() > refined * size)) break;
  }
  return {solution.head(n), solution.tail(r)};
}

template ConstrainedMinimum<double> minimize_under(const Eigen::SparseMatrix<double>&, const Eigen::VectorXd&,
                                                   const Eigen::SparseMatrix<double, Eigen::RowMajor>&,
                                                   const Eigen::VectorXd&);
template ConstrainedMinimum<std::complex<double>> minimize_under(
    const Eigen::SparseMatrix<std::complex<double>>&, const Eigen::VectorXcd&,
    const Eigen::SparseMatrix<std::complex<double>, Eigen::RowMajor>&, const Eigen::VectorXcd&);

}  // namespace lsgp
