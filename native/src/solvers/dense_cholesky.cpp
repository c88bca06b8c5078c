// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/dense_cholesky.hpp"

#include <utility>

#include "solvers/cholesky.hpp"
#include "solvers/dense_kernels.hpp"

namespace lsgp {

namespace {

// A front that is the whole matrix.
template <typename Scalar>
Front<Scalar> whole(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& matrix) {
  return {const_cast<Scalar*>(matrix.data()), static_cast<int>(matrix.rows()), 0, 0, nullptr};
}

}  // namespace

template <typename Scalar>
DenseCholesky<Scalar>::DenseCholesky(Matrix lower) : factor_(std::move(lower)) {
  if (factor_.size() > 0 && !dense_kernels<Scalar>().eliminate(whole(factor_), nullptr)) throw_unsolvable();
}

template <typename Scalar>
void DenseCholesky<Scalar>::solve_in_place(Eigen::Ref<Matrix> right_sides) const {
  if (factor_.size() == 0) return;
  constexpr int width = 8;
  Eigen::Matrix<Scalar, Eigen::Dynamic, width, Eigen::RowMajor> block(factor_.rows(), width);
  for (Eigen::Index begin = 0; begin < right_sides.cols(); begin += width) {
    const Eigen::Index used = std::min<Eigen::Index>(width, right_sides.cols() - begin);
    block.setZero();
    block.leftCols(used) = right_sides.middleCols(begin, used);
    dense_kernels<Scalar>().substitute_forward(whole(factor_), width, block.data(), nullptr);
    dense_kernels<Scalar>().substitute_backward(whole(factor_), width, block.data(), nullptr);
    right_sides.middleCols(begin, used) = block.leftCols(used);
  }
}

template class DenseCholesky<double>;
template class DenseCholesky<std::complex<double>>;

}  // namespace lsgp
