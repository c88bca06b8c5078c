// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/cholesky.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <utility>

#include "base/thread_team.hpp"
#include "lsgp/errors.hpp"
#include "random_matrices.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace {

constexpr double rounding = 1e-10;
constexpr int sizes[]{1, 2, 7, 40, 150, 400};

// Of the whole system, by Eigen's dense factorization.
template <typename Scalar, typename Sides>
Sides oracle(const Eigen::SparseMatrix<Scalar>& lower, const Sides& right_sides) {
  return full(lower).llt().solve(right_sides);
}

// Each point of a grid joined to those beside it, large enough for threads. The last row of points comes last.
template <typename Scalar>
Eigen::SparseMatrix<Scalar> grid_definite(Random& random, int width, int height) {
  std::vector<Eigen::Triplet<Scalar>> entries;
  Eigen::VectorXd sum = Eigen::VectorXd::Constant(width * height, 1e-3);
  const auto join = [&](int i, int j) {
    const Scalar value = random_scalar<Scalar>(random);
    entries.emplace_back(j, i, value);
    sum[i] += std::abs(value);
    sum[j] += std::abs(value);
  };
  for (int i = 0; i < width * height; ++i) {
    if (i % width + 1 < width) join(i, i + 1);
    if (i + width < width * height) join(i, i + width);
    if (i % width + 1 < width && i + width < width * height) join(i, i + width + 1);
  }
  for (int i = 0; i < width * height; ++i) entries.emplace_back(i, i, Scalar(sum[i]));
  Eigen::SparseMatrix<Scalar> out(width * height, width * height);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

constexpr int grid_width = 150, grid_height = 140;
constexpr int thread_counts[]{2, 3, 8, 64};

}  // namespace

TEST_CASE_TEMPLATE("a factor solves", Scalar, double, std::complex<double>) {
  Random random(1);
  for (const int size : sizes) {
    for (const int neighbors : {0, 2, 6, 20}) {
      for (const int sides : {1, 2, 3, 8, 19}) {
        CAPTURE(size);
        CAPTURE(neighbors);
        CAPTURE(sides);
        const auto lower = random_definite<Scalar>(random, size, neighbors);
        const auto right = random_matrix<Scalar>(random, size, sides);
        const lsgp::Cholesky<Scalar> factor(lower);
        REQUIRE(factor.size() == size);
        CHECK((factor.solve(right) - oracle(lower, right)).norm() < rounding * right.norm() * size);
      }
    }
  }
}

TEST_CASE_TEMPLATE("retained rows keep their Schur complement", Scalar, double, std::complex<double>) {
  Random random(2);
  for (const int size : sizes) {
    for (const int retained : {0, 1, size / 3, size}) {
      CAPTURE(size);
      CAPTURE(retained);
      const int rest = size - retained;
      const auto lower = random_definite<Scalar>(random, size, 6);
      const auto matrix = full(lower);
      const lsgp::Cholesky<Scalar> factor(lower, retained);
      const auto corner = matrix.bottomRightCorner(retained, retained);
      auto expected = corner.eval();
      if (rest > 0 && retained > 0) {
        expected -= matrix.bottomLeftCorner(retained, rest) *
                    matrix.topLeftCorner(rest, rest).llt().solve(matrix.topRightCorner(rest, retained));
      }
      CHECK((factor.schur() - expected).norm() <= rounding * matrix.norm());
    }
  }
}

TEST_CASE_TEMPLATE("two half solves about the Schur complement's own make a whole one", Scalar, double,
                   std::complex<double>) {
  using Matrix = typename lsgp::Cholesky<Scalar>::Matrix;
  using Rows = typename lsgp::Cholesky<Scalar>::Rows;
  Random random(3);
  for (const int sides : {1, 2, 5, 8}) {
    const int size = 120, retained = 30;
    CAPTURE(sides);
    const auto lower = random_definite<Scalar>(random, size, 5);
    const Matrix right = random_matrix<Scalar>(random, size, sides);
    const lsgp::Cholesky<Scalar> factor(lower, retained);
    Rows half = Rows::Zero(size, lsgp::Cholesky<Scalar>::width_for(sides));
    for (int row = 0; row < size; ++row) half.row(factor.place(row)).head(sides) = right.row(row);
    factor.eliminate(half);
    const Matrix reduced = half.bottomRows(retained);
    half.bottomRows(retained) = factor.schur().llt().solve(reduced);
    factor.substitute(half);
    Matrix solution(size, sides);
    for (int row = 0; row < size; ++row) solution.row(row) = half.row(factor.place(row)).head(sides);
    CHECK((solution - oracle(lower, right)).norm() < rounding * right.norm() * size);
  }
}

TEST_CASE("retained rows come last, in their own order") {
  Random random(4);
  const lsgp::Cholesky<double> factor(random_definite<double>(random, 50, 4), 10);
  for (int row = 40; row < 50; ++row) CHECK(factor.place(row) == row);
}

TEST_CASE_TEMPLATE("other values in the same places are factored anew", Scalar, double, std::complex<double>) {
  Random random(5);
  auto lower = random_definite<Scalar>(random, 90, 6);
  lsgp::Cholesky<Scalar> factor(lower);
  lower.coeffs() *= Scalar(3);
  lower.diagonal().array() += Scalar(2);
  factor.refactor(lower);
  const auto right = random_matrix<Scalar>(random, 90, 4);
  CHECK((factor.solve(right) - oracle(lower, right)).norm() < rounding * right.norm());
}

TEST_CASE_TEMPLATE("a matrix that is not positive definite is refused", Scalar, double, std::complex<double>) {
  Random random(6);
  for (const int bad : {0, 33, 79}) {
    CAPTURE(bad);
    auto lower = random_definite<Scalar>(random, 80, 6);
    lower.coeffRef(bad, bad) = Scalar(-1);
    CHECK_THROWS_AS(lsgp::Cholesky<Scalar>(lower, 0), const lsgp::Error&);
  }
  // What is retained is not factored.
  auto lower = random_definite<Scalar>(random, 80, 6);
  lower.coeffRef(79, 79) = Scalar(-1);
  CHECK_NOTHROW(lsgp::Cholesky<Scalar>(lower, 1));
}

TEST_CASE_TEMPLATE("any number of threads gives the same bytes", Scalar, double, std::complex<double>) {
  Random random(9);
  const auto lower = grid_definite<Scalar>(random, grid_width, grid_height);
  const auto right = random_matrix<Scalar>(random, lower.rows(), 2);
  const auto factored = [&](int threads, int retained) {
    const lsgp::ThreadCount count(threads);
    return lsgp::Cholesky<Scalar>(lower, retained);
  };
  const auto whole = factored(1, 0).solve(right);
  const auto product = (lower.template selfadjointView<Eigen::Lower>() * whole).eval();
  CHECK((product - right).norm() < rounding * right.norm());

  const int eliminated = static_cast<int>(lower.rows()) - grid_width;
  const auto schur = factored(1, grid_width).schur();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<Scalar>> rest(lower.topLeftCorner(eliminated, eliminated));
  const auto across = full<Scalar>(lower.bottomRightCorner(grid_width + grid_width, grid_width + grid_width))
                          .bottomLeftCorner(grid_width, grid_width)
                          .eval();
  auto sides = full<Scalar>(lower.bottomRightCorner(grid_width, grid_width));
  sides.setZero(eliminated, grid_width);
  sides.bottomRows(grid_width) = across.adjoint();
  const auto solved = rest.solve(sides).eval();
  const auto expected =
      (full<Scalar>(lower.bottomRightCorner(grid_width, grid_width)) - across * solved.bottomRows(grid_width)).eval();
  CHECK((schur - expected).norm() < rounding * expected.norm());

  for (const int threads : thread_counts) {
    CAPTURE(threads);
    CHECK(factored(threads, 0).solve(right) == whole);
    CHECK(factored(threads, grid_width).schur() == schur);
  }
}

TEST_CASE_TEMPLATE("solves on any number of threads give the same bytes", Scalar, double, std::complex<double>) {
  Random random(11);
  const auto lower = grid_definite<Scalar>(random, grid_width, grid_height);
  const int size = static_cast<int>(lower.rows());
  const auto right = random_matrix<Scalar>(random, size, 19);
  // All of them with nothing retained, and the first two in halves with the last rows retained.
  const auto solve = [&](int threads) {
    const lsgp::ThreadCount count(threads);
    const lsgp::LinearAlgebraCounter counter;
    auto whole = lsgp::Cholesky<Scalar>(lower).solve(right);
    CHECK(counter.counted().back_substitutions == 19);
    const lsgp::Cholesky<Scalar> factor(lower, grid_width);
    typename lsgp::Cholesky<Scalar>::Rows half(size, 2);
    for (int row = 0; row < size; ++row) half.row(factor.place(row)) = right.row(row).head(2);
    factor.eliminate(half);
    const auto reduced = half.bottomRows(grid_width).eval();
    half.bottomRows(grid_width) = factor.schur().llt().solve(reduced);
    factor.substitute(half);
    Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> in_halves(size, 2);
    for (int row = 0; row < size; ++row) in_halves.row(row) = half.row(factor.place(row));
    return std::pair(whole, in_halves);
  };
  const auto alone = solve(1);
  CHECK((lower.template selfadjointView<Eigen::Lower>() * alone.first - right).norm() < rounding * right.norm());
  CHECK((alone.second - alone.first.leftCols(2)).norm() < rounding * alone.second.norm());
  for (const int threads : thread_counts) {
    CAPTURE(threads);
    CHECK(solve(threads) == alone);
  }
}

TEST_CASE("threads stop where a matrix is not positive definite") {
  Random random(10);
  const auto lower = grid_definite<double>(random, grid_width, grid_height);
  const lsgp::ThreadCount count(3);
  for (const int bad : {5, grid_width * grid_height / 2, grid_width * grid_height - 1}) {
    CAPTURE(bad);
    auto wrong = lower;
    wrong.coeffRef(bad, bad) = -1;
    CHECK_THROWS_AS(lsgp::Cholesky<double>(wrong, 0), const lsgp::Error&);
  }
}

TEST_CASE("factorizations and back-substitutions are counted by the innermost counter") {
  Random random(7);
  const auto lower = random_definite<double>(random, 20, 4);
  const lsgp::LinearAlgebraCounter outer;
  lsgp::Cholesky<double> factor(lower);
  {
    const lsgp::LinearAlgebraCounter inner;
    factor.refactor(lower);
    factor.solve(random_matrix<double>(random, 20, 3));
    CHECK(inner.counted().factorizations == 1);
    CHECK(inner.counted().back_substitutions == 3);
  }
  CHECK(outer.counted().factorizations == 1);
  CHECK(outer.counted().back_substitutions == 0);
}

TEST_CASE("a factor takes another one's memory") {
  Random random(8);
  const auto first = random_definite<double>(random, 60, 4), second = random_definite<double>(random, 50, 4);
  lsgp::Cholesky<double> factor(first);
  const lsgp::Cholesky<double> next(second, 0, factor.take_memory());
  const auto right = random_matrix<double>(random, 50, 2);
  CHECK((next.solve(right) - oracle(second, right)).norm() < rounding * right.norm());
}
