// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest eigenvector of a Hermitian pencil.
#pragma once

#include <Eigen/SparseCore>
#include <complex>

#include "solvers/cholesky.hpp"

namespace lsgp {

// The eigenvector of  form x = lambda norm x  with the smallest lambda.
// form: Hermitian positive semidefinite; norm: Hermitian positive definite; both lower triangles, (n, n).
// Throws SolverFailure where the iteration does not converge.
Eigen::VectorXcd smallest_eigenvector(const Eigen::SparseMatrix<std::complex<double>>& form,
                                      const Eigen::SparseMatrix<std::complex<double>>& norm);
Eigen::VectorXcd smallest_eigenvector(const Eigen::MatrixXcd& form, const Eigen::MatrixXcd& norm);

// The factor of form + share * norm, share just large enough for a form that is singular because its map is exact.
// Throws SolverFailure where none is.
Cholesky<std::complex<double>> factor_regularized(const Eigen::SparseMatrix<std::complex<double>>& form,
                                                  const Eigen::SparseMatrix<std::complex<double>>& norm);

}  // namespace lsgp
