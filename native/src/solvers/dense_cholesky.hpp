// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky factorization of dense real symmetric and complex Hermitian positive definite matrices.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

namespace lsgp {

template <typename Scalar>
class DenseCholesky {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  // lower: its lower triangle is read. Throws SolverFailure where it is not positive definite.
  explicit DenseCholesky(Matrix lower);
  // None where it is not positive definite.
  static std::optional<DenseCholesky> factored(Matrix lower);

  // One right-hand side per column.
  Matrix solve(const Eigen::Ref<const Matrix>& right_sides) const;

 private:
  DenseCholesky() = default;
  bool factorize();

  Matrix factor_;
};

extern template class DenseCholesky<double>;
extern template class DenseCholesky<std::complex<double>>;

}  // namespace lsgp
