// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/cholesky.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "lsgp/errors.hpp"

namespace lsgp {

template <typename Scalar>
struct Cholesky<Scalar>::Factor {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<Scalar>, Eigen::Lower> ldlt;
  Definiteness definiteness;
};

template <typename Scalar>
Cholesky<Scalar>::Cholesky(const Eigen::SparseMatrix<Scalar>& lower, Definiteness definiteness)
    : factor_(std::make_unique<Factor>()) {
  factor_->definiteness = definiteness;
  if (lower.rows() == 0) return;
  factor_->ldlt.analyzePattern(lower);
  refactor(lower);
}

template <typename Scalar>
void Cholesky<Scalar>::refactor(const Eigen::SparseMatrix<Scalar>& lower) {
  if (lower.rows() == 0) return;
  factor_->ldlt.factorize(lower);
  const Eigen::VectorXd pivots = factor_->ldlt.vectorD().real();
  const bool usable =
      factor_->definiteness == Definiteness::positive ? (pivots.array() > 0).all() : (pivots.array() != 0).all();
  if (factor_->ldlt.info() != Eigen::Success || !usable) {
    throw Error(
        Code::solver_failed,
        "A linear system could not be factored: the surface has triangles too thin or too large to compute with. "
        "Clean the mesh (merge by distance, dissolve degenerate faces) and try again.");
  }
}

template <typename Scalar>
Cholesky<Scalar>::~Cholesky() = default;
template <typename Scalar>
Cholesky<Scalar>::Cholesky(Cholesky&&) noexcept = default;

template <typename Scalar>
typename Cholesky<Scalar>::Vector Cholesky<Scalar>::solve(const Vector& right_side) const {
  if (right_side.size() == 0) return right_side;
  return factor_->ldlt.solve(right_side);
}

// Eigen solves column by column; with the columns side by side each entry of the factor is read once a block.
template <typename Scalar>
typename Cholesky<Scalar>::Matrix Cholesky<Scalar>::solve(const Matrix& right_sides) const {
  constexpr int block = 8;
  using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, block, Eigen::RowMajor>;
  const Eigen::Index n = right_sides.rows(), count = right_sides.cols();
  Matrix solution(n, count);
  if (n == 0) return solution;
  const auto& ldlt = factor_->ldlt;
  const Eigen::SparseMatrix<Scalar>& lower = ldlt.matrixL().nestedExpression();
  const Vector diagonal = ldlt.vectorD();
  const auto& permutation = ldlt.permutationP().indices();
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  const Scalar* value = lower.valuePtr();
  Block x(n, block);
  for (Eigen::Index begin = 0; begin < count; begin += block) {
    const Eigen::Index width = std::min<Eigen::Index>(block, count - begin);
    x.setZero();
    for (Eigen::Index i = 0; i < n; ++i) x.row(permutation[i]).head(width) = right_sides.row(i).segment(begin, width);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (int k = outer[j]; k < outer[j + 1]; ++k) {
        if (inner[k] > j) x.row(inner[k]) -= value[k] * x.row(j);
      }
    }
    for (Eigen::Index j = 0; j < n; ++j) x.row(j) /= diagonal[j];
    for (Eigen::Index j = n; j-- > 0;) {
      for (int k = outer[j]; k < outer[j + 1]; ++k) {
        if (inner[k] > j) x.row(j) -= Eigen::numext::conj(value[k]) * x.row(inner[k]);
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) solution.row(i).segment(begin, width) = x.row(permutation[i]).head(width);
  }
  return solution;
}

template class Cholesky<double>;
template class Cholesky<std::complex<double>>;

}  // namespace lsgp
