// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/dense_cholesky.hpp"

#include <utility>

#include "base/checkpoint.hpp"
#include "base/thread_team.hpp"
#include "solvers/cholesky.hpp"
#include "solvers/dense_kernels.hpp"
#include "solvers/failure.hpp"
#include "solvers/front_blocks.hpp"
#include "solvers/solve_blocks.hpp"

namespace lsgp {

namespace {

constexpr int least_rows_of_threads = 500;  // which take time to start

// A front that is the whole matrix.
template <typename Scalar>
Front<Scalar> whole(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& matrix) {
  return {const_cast<Scalar*>(matrix.data()), static_cast<int>(matrix.rows()), 0, 0, nullptr};
}

}  // namespace

template <typename Scalar>
DenseCholesky<Scalar>::DenseCholesky(Matrix lower) : factor_(std::move(lower)) {
  if (!factorize()) throw SolverFailure(SolverFailure::Cause::not_positive_definite);
}

template <typename Scalar>
std::optional<DenseCholesky<Scalar>> DenseCholesky<Scalar>::factored(Matrix lower) {
  DenseCholesky out;
  out.factor_ = std::move(lower);
  if (!out.factorize()) return std::nullopt;
  return out;
}

template <typename Scalar>
bool DenseCholesky<Scalar>::factorize() {
  const Front<Scalar> front = whole(factor_);
  if (has_blocks(front)) {
    ThreadTeam alone(1);
    return eliminate_by_blocks(front, front.columns < least_rows_of_threads ? alone : team_of_this_call());
  }
  const double size = static_cast<double>(factor_.rows());
  const bool done = factor_.size() == 0 || dense_kernels<Scalar>().eliminate(front);
  checkpoint(size * size * size / 6);
  return done;
}

template <typename Scalar>
typename DenseCholesky<Scalar>::Matrix DenseCholesky<Scalar>::solve(const Eigen::Ref<const Matrix>& right_sides) const {
  Matrix out(right_sides.rows(), right_sides.cols());
  for_each_block(out.cols(), out.rows(), [&](const SolveBlock& block) {
    typename Cholesky<Scalar>::Rows x = Cholesky<Scalar>::Rows::Zero(out.rows(), block.width);
    x.leftCols(block.used) = right_sides.middleCols(block.begin, block.used);
    const int width = static_cast<int>(block.width);
    dense_kernels<Scalar>().substitute_forward(whole(factor_), width, x.data(), nullptr);
    dense_kernels<Scalar>().substitute_backward(whole(factor_), width, x.data(), nullptr);
    out.middleCols(block.begin, block.used) = x.leftCols(block.used);
  });
  return out;
}

template class DenseCholesky<double>;
template class DenseCholesky<std::complex<double>>;

}  // namespace lsgp
