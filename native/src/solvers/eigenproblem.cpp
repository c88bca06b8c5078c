// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/eigenproblem.hpp"

#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "solvers/cholesky.hpp"
#include "solvers/dense_cholesky.hpp"
#include "solvers/failure.hpp"

namespace lsgp {

namespace {

using Complex = std::complex<double>;
using ComplexSparse = Eigen::SparseMatrix<Complex>;

// The eigenvalues of a conformal form relative to its Dirichlet form lie between 0 and 1; a shift of 1e-12 does not
// change the eigenvector, and makes the form of a surface that unfolds exactly definite.
constexpr double shift = 1e-12;
// That of large surfaces is definite only up to rounding, which grows with their size, and takes more.
constexpr double largest_shift = 1e-8, next_shift = 100;
constexpr double tolerance = 1e-13;
constexpr int krylov_dimension = 24;
constexpr int most_restarts = 400;

// Spectra 1.0 supports real symmetric operators only: a complex vector is passed as its real parts followed by its
// imaginary parts.
Eigen::VectorXcd to_complex(const double* x, Eigen::Index n) {
  Eigen::VectorXcd out(n);
  out.real() = Eigen::Map<const Eigen::VectorXd>(x, n);
  out.imag() = Eigen::Map<const Eigen::VectorXd>(x + n, n);
  return out;
}

void to_real(const Eigen::VectorXcd& z, double* y) {
  Eigen::Map<Eigen::VectorXd>(y, z.size()) = z.real();
  Eigen::Map<Eigen::VectorXd>(y + z.size(), z.size()) = z.imag();
}

template <typename Factor, typename Matrix>
Factor factor_shifted(const Matrix& form, const Matrix& norm) {
  for (double share = shift;; share *= next_shift) {
    try {
      return Factor(form + share * norm);
    } catch (const SolverFailure& failure) {
      if (failure.cause != SolverFailure::Cause::not_positive_definite || share >= largest_shift) throw;
    }
  }
}

template <typename Factor>
class ShiftedInverse {
 public:
  using Scalar = double;
  template <typename Matrix>
  ShiftedInverse(const Matrix& form, const Matrix& norm)
      : size_(form.rows()), factor_(factor_shifted<Factor>(form, norm)) {}
  Eigen::Index rows() const { return 2 * size_; }
  Eigen::Index cols() const { return 2 * size_; }
  void set_shift(double) {}  // fixed when the factor was made
  void perform_op(const double* x, double* y) const { to_real(factor_.solve(to_complex(x, size_)), y); }

 private:
  Eigen::Index size_;
  Factor factor_;
};

template <typename Matrix>
class NormProduct {
 public:
  using Scalar = double;
  explicit NormProduct(const Matrix& norm) : norm_(norm) {}
  Eigen::Index rows() const { return 2 * norm_.rows(); }
  Eigen::Index cols() const { return 2 * norm_.rows(); }
  void perform_op(const double* x, double* y) const {
    to_real(norm_.template selfadjointView<Eigen::Lower>() * to_complex(x, norm_.rows()), y);
  }

 private:
  const Matrix& norm_;
};

// A start vector without any symmetry, the same on every machine.
Eigen::VectorXcd unbiased_start(Eigen::Index size) {
  Eigen::VectorXcd start(size);
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  const auto uniform = [&] {  // splitmix64 (Steele et al. 2014)
    std::uint64_t x = state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-52 - 1;
  };
  for (Eigen::Index i = 0; i < size; ++i) {
    const double real = uniform(), imaginary = uniform();
    start[i] = {real, imaginary};
  }
  return start;
}

template <typename Factor, typename Matrix>
Eigen::VectorXcd find_smallest(const Matrix& form, const Matrix& norm) {
  const Eigen::Index n = form.rows();
  if (n == 1) return Eigen::VectorXcd::Ones(1);
  using Inverse = ShiftedInverse<Factor>;
  using Product = NormProduct<Matrix>;
  Inverse inverse(form, norm);
  Product product(norm);
  const Eigen::Index dimension = std::min<Eigen::Index>(krylov_dimension, 2 * n);
  Spectra::SymGEigsShiftSolver<Inverse, Product, Spectra::GEigsMode::ShiftInvert> solver(inverse, product, 1, dimension,
                                                                                         -shift);
  Eigen::VectorXd real_start(2 * n);
  to_real(unbiased_start(n), real_start.data());
  bool converged = false;
  try {
    solver.init(real_start.data());
    solver.compute(Spectra::SortRule::LargestMagn, most_restarts, tolerance);
    converged = solver.info() == Spectra::CompInfo::Successful;
  } catch (const std::runtime_error&) {     // thrown by Spectra if a small eigenproblem fails
  } catch (const std::invalid_argument&) {  // or if the start vector has norm zero
  }
  if (!converged) throw SolverFailure(SolverFailure::Cause::no_convergence);
  // For a singular form the inverse is so large in one direction that the Krylov basis loses the digits of the others;
  // two plain inverse iterations recover them.
  Eigen::VectorXd vector = solver.eigenvectors(1), image(2 * n);
  for (int i = 0; i < 2; ++i) {
    product.perform_op(vector.data(), image.data());
    inverse.perform_op(image.data(), vector.data());
    vector /= vector.norm();
  }
  return to_complex(vector.data(), n);
}

}  // namespace

Cholesky<Complex> factor_regularized(const ComplexSparse& form, const ComplexSparse& norm) {
  return factor_shifted<Cholesky<Complex>>(form, norm);
}

Eigen::VectorXcd smallest_eigenvector(const ComplexSparse& form, const ComplexSparse& norm) {
  return find_smallest<Cholesky<Complex>>(form, norm);
}

Eigen::VectorXcd smallest_eigenvector(const Eigen::MatrixXcd& form, const Eigen::MatrixXcd& norm) {
  return find_smallest<DenseCholesky<Complex>>(form, norm);
}

}  // namespace lsgp
