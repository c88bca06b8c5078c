// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky with Eigen's simplicial factorization of the rows that are not retained.
#include "solvers/cholesky.hpp"

#include <Eigen/SparseCholesky>

#include "solvers/failure.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

template <typename Scalar>
struct Cholesky<Scalar>::Factor {
  using Sparse = Eigen::SparseMatrix<Scalar>;

  Eigen::SimplicialLLT<Sparse> rest;  // P A P^H = L L^H of the eliminated rows
  Sparse coupling;                    // (retained, eliminated)
  Matrix schur;
  Eigen::Index size = 0, eliminated = 0;

  const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order() const { return rest.permutationP(); }
};

template <typename Scalar>
Cholesky<Scalar>::Cholesky(const Eigen::SparseMatrix<Scalar>& lower, int retained, Vector) : factor_(new Factor) {
  factor_->size = lower.rows();
  factor_->eliminated = lower.rows() - retained;
  refactor(lower);
}

template <typename Scalar>
void Cholesky<Scalar>::refactor(const Eigen::SparseMatrix<Scalar>& lower) {
  count_factorization();
  const Eigen::Index eliminated = factor_->eliminated, retained = factor_->size - eliminated;
  factor_->schur = Matrix(lower.bottomRightCorner(retained, retained)).template selfadjointView<Eigen::Lower>();
  if (eliminated == 0) return;
  factor_->rest.compute(lower.topLeftCorner(eliminated, eliminated));
  if (factor_->rest.info() != Eigen::Success) throw SolverFailure(SolverFailure::Cause::not_positive_definite);
  if (retained == 0) return;
  factor_->coupling = lower.bottomLeftCorner(retained, eliminated);
  const Matrix across = Matrix(factor_->coupling).adjoint();
  factor_->schur -= factor_->coupling * factor_->rest.solve(across);
}

template <typename Scalar>
typename Cholesky<Scalar>::Vector Cholesky<Scalar>::take_memory() {
  return {};
}

template <typename Scalar>
Cholesky<Scalar>::~Cholesky() = default;
template <typename Scalar>
Cholesky<Scalar>::Cholesky(Cholesky&&) noexcept = default;

template <typename Scalar>
Eigen::Index Cholesky<Scalar>::size() const {
  return factor_->size;
}

template <typename Scalar>
typename Cholesky<Scalar>::Vector Cholesky<Scalar>::solve(const Vector& right_side) const {
  return solve(Matrix(right_side));
}

template <typename Scalar>
typename Cholesky<Scalar>::Matrix Cholesky<Scalar>::solve(const Matrix& right_sides) const {
  count_back_substitutions(static_cast<int>(right_sides.cols()));
  return factor_->rest.solve(right_sides);
}

template <typename Scalar>
const typename Cholesky<Scalar>::Matrix& Cholesky<Scalar>::schur() const {
  return factor_->schur;
}

template <typename Scalar>
int Cholesky<Scalar>::place(int row) const {
  return row < factor_->eliminated ? factor_->order().indices()[row] : row;
}

// In the order of elimination: x1 = L^-1 x1,  x2 -= (L^-1 P B^H)^H x1.
template <typename Scalar>
void Cholesky<Scalar>::eliminate(Rows& right_sides) const {
  if (factor_->eliminated == 0) return;
  Matrix top = right_sides.topRows(factor_->eliminated);
  factor_->rest.matrixL().solveInPlace(top);
  right_sides.topRows(factor_->eliminated) = top;
  if (factor_->schur.size() == 0) return;
  factor_->rest.matrixU().solveInPlace(top);
  right_sides.bottomRows(factor_->schur.rows()) -= factor_->coupling * (factor_->order().inverse() * top);
}

// x1 = L^-H (x1 - L^-1 P B^H x2).
template <typename Scalar>
void Cholesky<Scalar>::substitute(Rows& half_solved) const {
  if (factor_->eliminated == 0) return;
  Matrix top = half_solved.topRows(factor_->eliminated);
  if (factor_->schur.size() > 0) {
    const Matrix retained = half_solved.bottomRows(factor_->schur.rows());
    Matrix across = factor_->order() * Matrix(factor_->coupling.adjoint() * retained);
    factor_->rest.matrixL().solveInPlace(across);
    top -= across;
  }
  factor_->rest.matrixU().solveInPlace(top);
  half_solved.topRows(factor_->eliminated) = top;
}

template class Cholesky<double>;
template class Cholesky<std::complex<double>>;

}  // namespace lsgp
