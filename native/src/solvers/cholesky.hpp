// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse Cholesky factorization of real symmetric and complex Hermitian positive definite matrices.
#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <memory>

namespace lsgp {

enum class Definiteness {
  positive,
  quasi,  // positive and negative definite diagonal blocks, as of a regularised saddle point (Vanderbei 1995)
};

template <typename Scalar>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  // lower: the lower triangle with its diagonal.  Throws SOLVER_FAILED where the matrix is not as definite as said.
  explicit Cholesky(const Eigen::SparseMatrix<Scalar>& lower, Definiteness definiteness = Definiteness::positive);
  // Factors another matrix whose entries are in the same places; a part of the work is saved.
  void refactor(const Eigen::SparseMatrix<Scalar>& lower);
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;

  Vector solve(const Vector& right_side) const;
  Matrix solve(const Matrix& right_sides) const;  // one right side a column, several at a time

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

extern template class Cholesky<double>;
extern template class Cholesky<std::complex<double>>;

}  // namespace lsgp
