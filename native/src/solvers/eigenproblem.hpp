// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest eigenvector of a Hermitian pencil.
#pragma once

#include <Eigen/SparseCore>
#include <complex>

namespace lsgp {

// The eigenvector of  form x = lambda norm x  with the smallest lambda.
// form: Hermitian positive semidefinite; norm: Hermitian positive definite; both lower triangles, (n, n).
// start: where the iteration begins.  Throws SOLVER_FAILED where it does not converge.
Eigen::VectorXcd smallest_eigenvector(const Eigen::SparseMatrix<std::complex<double>>& form,
                                      const Eigen::SparseMatrix<std::complex<double>>& norm,
                                      const Eigen::VectorXcd& start);

// A start vector without any symmetry, the same on every machine.
Eigen::VectorXcd unbiased_start(Eigen::Index size);

// form + share * norm, share just large enough to factor a form that is singular because its map is exact.
Eigen::SparseMatrix<std::complex<double>> regularized(const Eigen::SparseMatrix<std::complex<double>>& form,
                                                      const Eigen::SparseMatrix<std::complex<double>>& norm);

}  // namespace lsgp
