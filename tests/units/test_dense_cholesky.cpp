// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/dense_cholesky.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "lsgp/errors.hpp"
#include "random_matrices.hpp"

TEST_CASE_TEMPLATE("a dense factor solves", Scalar, double, std::complex<double>) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  Random random(1);
  for (const int size : {0, 1, 5, 16, 17, 64, 130}) {
    for (const int sides : {1, 3, 11}) {
      CAPTURE(size);
      CAPTURE(sides);
      const Matrix root = random_matrix<Scalar>(random, size, size);
      const Matrix matrix = root * root.adjoint() + Matrix::Identity(size, size);
      const Matrix right = random_matrix<Scalar>(random, size, sides);
      Matrix lower = matrix;
      lower.template triangularView<Eigen::StrictlyUpper>().fill(Scalar(NAN));  // is not read
      CHECK((matrix * lsgp::DenseCholesky<Scalar>(lower).solve(right) - right).norm() <= 1e-11 * matrix.norm());
    }
  }
}

TEST_CASE("a dense matrix that is not positive definite has no factor") {
  for (const int size : {2, 40}) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
    matrix(size - 1, size - 1) = -1;
    CHECK_FALSE(lsgp::DenseCholesky<double>::factored(matrix).has_value());
    CHECK_THROWS_AS(lsgp::DenseCholesky<double>{matrix}, const lsgp::Error&);
  }
}

TEST_CASE("a positive diagonal does not make a dense matrix positive definite") {
  for (const int size : {2, 40, 130}) {
    for (const int row : {1, size - 1}) {
      CAPTURE(size);
      CAPTURE(row);
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
      matrix(row, row - 1) = matrix(row - 1, row) = 2;
      CHECK_FALSE(lsgp::DenseCholesky<double>::factored(matrix).has_value());
    }
  }
}
