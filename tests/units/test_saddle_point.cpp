// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/saddle_point.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include "random_matrices.hpp"

TEST_CASE_TEMPLATE("a form is minimized under equations", Scalar, double, std::complex<double>) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  Random random(1);
  for (const int size : {3, 30, 120}) {
    for (const int equations : {0, 1, 3}) {
      CAPTURE(size);
      CAPTURE(equations);
      const auto lower = random_definite<Scalar>(random, size, 5);
      const Matrix rows = random_matrix<Scalar>(random, equations, size);
      const Vector right = random_matrix<Scalar>(random, size, 1), values = random_matrix<Scalar>(random, equations, 1);
      const auto found = lsgp::minimize_under<Scalar>(
          lower, right, Eigen::SparseMatrix<Scalar, Eigen::RowMajor>(rows.sparseView()), values);

      // The conditions of Lagrange, as one dense system.
      Matrix system = Matrix::Zero(size + equations, size + equations);
      system.topLeftCorner(size, size) = full(lower);
      system.topRightCorner(size, equations) = rows.adjoint();
      system.bottomLeftCorner(equations, size) = rows;
      Vector whole(size + equations);
      whole << right, values;
      const Vector solution = system.partialPivLu().solve(whole);
      CHECK((found.x - solution.head(size)).norm() < 1e-8 * (1 + solution.norm()));
      CHECK((found.multipliers - solution.tail(equations)).norm() < 1e-8 * (1 + solution.norm()));
      CHECK((rows * found.x - values).norm() < 1e-10 * (1 + values.norm()));
    }
  }
}
