// SPDX-License-Identifier: GPL-3.0-or-later
// Products of dense matrices of hundreds of rows, which take seconds.
#pragma once

#include <Eigen/Core>

namespace lsgp {

// left * right; the caller is let in between blocks of columns.
Eigen::MatrixXcd multiplied(const Eigen::MatrixXcd& left, const Eigen::MatrixXcd& right);

}  // namespace lsgp
