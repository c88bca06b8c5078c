// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse Cholesky factorization of real symmetric and complex Hermitian positive definite matrices: multifrontal (Duff
// and Reid 1983, Liu 1992), and able to stop before the last rows.
#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <memory>

namespace lsgp {

template <typename Scalar>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  // lower: the lower triangle with its diagonal.  retained: how many of the last rows are not eliminated; the
  // elimination of the others leaves their Schur complement.  memory: of a factor that is no longer needed, for reuse.
  // Throws SolverFailure where the eliminated part is not positive definite.
  explicit Cholesky(const Eigen::SparseMatrix<Scalar>& lower, int retained = 0, Vector memory = {});
  // Gives up the factor's memory; the factor cannot be used afterward.
  Vector take_memory();
  // Factors another matrix of the same sparsity pattern; the symbolic factorization is reused.
  void refactor(const Eigen::SparseMatrix<Scalar>& lower);
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;

  Eigen::Index size() const;

  // One right-hand side per column; nothing may be retained.
  Vector solve(const Vector& right_side) const;
  Matrix solve(const Matrix& right_sides) const;

  // The Schur complement of the retained rows, (retained, retained).
  const Matrix& schur() const;

  // A solve in two halves. Values come in the order of elimination, those of retained rows last: one, two or
  // `solve_width` right-hand sides next to each other, the last of which may be padding.
  using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr int solve_width = 8;
  static Eigen::Index width_for(Eigen::Index sides) { return sides > 2 ? solve_width : sides; }
  int place(int row) const;  // of a row in that order
  // Performs half a solve on right-hand sides; the last rows become the right-hand sides of the retained rows' system.
  void eliminate(Rows& right_sides) const;
  // Expects the solution of that system in their place and computes the others. The caller counts the
  // back-substitutions, on the thread of the call.
  void substitute(Rows& half_solved) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

extern template class Cholesky<double>;
extern template class Cholesky<std::complex<double>>;

}  // namespace lsgp
