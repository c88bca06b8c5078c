// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_qp.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "random_matrices.hpp"

namespace {

struct Program {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient, low, high;
};

Program random_program(Random& random, int size) {
  const Eigen::MatrixXd root = random_matrix<double>(random, size, size);
  Program out{root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size),
              5 * random_matrix<double>(random, size, 1), Eigen::VectorXd(size), Eigen::VectorXd(size)};
  for (int i = 0; i < size; ++i) {
    // A variable in eight is fixed, one in eight has no bound.
    const int kind = below(random, 8);
    out.low[i] = kind == 0 ? 0 : kind == 1 ? -1e9 : -between(random, 0, 1);
    out.high[i] = kind == 0 ? 0 : kind == 1 ? 1e9 : between(random, 0, 1);
  }
  return out;
}

// How far a point is from the conditions of Karush, Kuhn and Tucker, the multiplier of the sum being the one that suits
// the free variables.
double miss_of_optimality(const Program& program, const Eigen::VectorXd& d, bool keep_sum) {
  const Eigen::VectorXd slope = program.gradient + program.hessian * d;
  const double edge = 1e-10;
  double lowest = -INFINITY, highest = INFINITY;  // that the multiplier may have
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    if (d[i] > program.low[i] + edge) highest = std::min(highest, -slope[i]);
    if (d[i] < program.high[i] - edge) lowest = std::max(lowest, -slope[i]);
  }
  return keep_sum ? std::max(0.0, lowest - highest) : std::max({0.0, lowest, -highest});
}

}  // namespace

TEST_CASE("a program between bounds ends where no direction lowers it") {
  Random random(1);
  for (const bool keep_sum : {false, true}) {
    for (const int size : {1, 2, 5, 20, 64, 65, 150}) {
      for (int round = 0; round < 5; ++round) {
        CAPTURE(keep_sum);
        CAPTURE(size);
        const Program program = random_program(random, size);
        lsgp::BoxProgram solver(keep_sum);
        solver.set_hessian(program.hessian);
        const Eigen::VectorXd d = solver.minimize(program.gradient, program.low, program.high);
        CHECK((d.array() >= program.low.array()).all());
        CHECK((d.array() <= program.high.array()).all());
        if (keep_sum) CHECK(std::abs(d.sum()) < 1e-9);
        CHECK(miss_of_optimality(program, d, keep_sum) < 1e-7);
      }
    }
  }
}

TEST_CASE("what a program remembers does not change the next one's minimum") {
  Random random(2);
  Program program = random_program(random, 12);
  lsgp::BoxProgram kept(true);
  kept.set_hessian(program.hessian);
  for (int round = 0; round < 20; ++round) {
    program.gradient = 5 * random_matrix<double>(random, 12, 1);
    lsgp::BoxProgram fresh(true);
    fresh.set_hessian(program.hessian);
    const auto found = kept.minimize(program.gradient, program.low, program.high);
    CHECK((found - fresh.minimize(program.gradient, program.low, program.high)).norm() < 1e-8);
  }
}

TEST_CASE("the nearest point with a sum is the wanted one moved by one shift and held by the bounds") {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    const Eigen::VectorXd low = random_matrix<double>(random, 9, 1);
    const Eigen::VectorXd high = low + random_matrix<double>(random, 9, 1).cwiseAbs();
    const Eigen::VectorXd wanted = 2 * random_matrix<double>(random, 9, 1);
    const double sum = between(random, low.sum(), high.sum());
    const Eigen::VectorXd found = lsgp::nearest_with_sum(low, high, wanted, sum);
    CHECK(found.sum() == doctest::Approx(sum).epsilon(1e-9));
    double shift_low = -INFINITY, shift_high = INFINITY;
    for (Eigen::Index i = 0; i < 9; ++i) {
      REQUIRE(found[i] >= low[i]);
      REQUIRE(found[i] <= high[i]);
      if (found[i] > low[i]) shift_low = std::max(shift_low, found[i] - wanted[i]);
      if (found[i] < high[i]) shift_high = std::min(shift_high, found[i] - wanted[i]);
    }
    CHECK(shift_low <= shift_high + 1e-9);
  }
  // Beyond all bounds the nearest sum is theirs.
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3), one = Eigen::VectorXd::Ones(3);
  CHECK(lsgp::nearest_with_sum(zero, one, zero, 9).sum() == 3);
  CHECK(lsgp::nearest_with_sum(zero, one, zero, -9).sum() == 0);
}
