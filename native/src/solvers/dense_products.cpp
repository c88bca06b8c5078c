// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/dense_products.hpp"

#include <algorithm>

#include "base/checkpoint.hpp"

namespace lsgp {

Eigen::MatrixXcd multiplied(const Eigen::MatrixXcd& left, const Eigen::MatrixXcd& right) {
  constexpr double real_products = 4;         // of a complex one
  constexpr Eigen::Index least_columns = 16;  // fewer would read all of `left` too often
  const double of_column = real_products * static_cast<double>(left.rows()) * static_cast<double>(left.cols());
  const Eigen::Index at_once =
      std::max(least_columns, static_cast<Eigen::Index>(4 * operations_between_visits / std::max(of_column, 1.0)));
  Eigen::MatrixXcd out(left.rows(), right.cols());
  for (Eigen::Index begin = 0; begin < right.cols(); begin += at_once) {
    const Eigen::Index columns = std::min(at_once, right.cols() - begin);
    out.middleCols(begin, columns).noalias() = left * right.middleCols(begin, columns);
    checkpoint(of_column * static_cast<double>(columns));
  }
  return out;
}

}  // namespace lsgp
