// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/lattice_search.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "plane/point_lattice.hpp"
#include "random_matrices.hpp"

namespace {

Eigen::MatrixXcd random_form(Random& random, int size) {
  const Eigen::MatrixXcd root = random_matrix<lsgp::Complex>(random, size, size);
  return root * root.adjoint() + 0.01 * Eigen::MatrixXcd::Identity(size, size);
}

double cost(const Eigen::MatrixXcd& form, const Eigen::VectorXcd& off) { return off.dot(form * off).real(); }

std::vector<lsgp::Complex> points_near(const lsgp::PointLattice& lattice, lsgp::Complex z, int steps) {
  const auto middle = lattice.nearest_coordinates(z);
  std::vector<lsgp::Complex> out;
  for (int a = -steps; a <= steps; ++a) {
    for (int b = -steps; b <= steps; ++b) out.push_back(lattice.point({middle[0] + a, middle[1] + b}));
  }
  return out;
}

}  // namespace

TEST_CASE("the nearest point of a lattice is the nearest") {
  Random random(1);
  for (const int rotation_order : {4, 6}) {
    const lsgp::PointLattice lattice(rotation_order);
    for (int round = 0; round < 500; ++round) {
      const lsgp::Complex z(between(random, -9, 9), between(random, -9, 9));
      double least = INFINITY;
      for (const lsgp::Complex point : points_near(lattice, z, 2)) least = std::min(least, std::abs(z - point));
      CHECK(std::abs(z - lattice.nearest(z)) == doctest::Approx(least));
    }
  }
}

TEST_CASE("turns of a lattice map it onto itself") {
  for (const int rotation_order : {1, 2, 3, 4, 6}) {
    const lsgp::PointLattice lattice(rotation_order);
    CHECK(std::abs(lattice.unit(1) - std::polar(1.0, 2 * M_PI / rotation_order)) < 1e-15);
    CHECK(lattice.unit(rotation_order) == lsgp::Complex(1, 0));
    CHECK(lattice.unit(-1) == lattice.unit(rotation_order - 1));
    if (rotation_order < 3) continue;
    const lsgp::Complex turned = lattice.unit(1) * lattice.point({3, -2});
    CHECK(std::abs(turned - lattice.nearest(turned)) < 1e-12);
  }
}

TEST_CASE("a reduced basis spans the same lattice with vectors that are not longer") {
  Random random(2);
  for (const int rotation_order : {4, 6}) {
    const lsgp::PointLattice lattice(rotation_order);
    for (const int size : {1, 2, 3, 6}) {
      CAPTURE(rotation_order);
      CAPTURE(size);
      const Eigen::MatrixXcd form = random_form(random, size);
      const Eigen::MatrixXcd basis = lsgp::reduce_basis(form, lattice);
      CHECK(std::abs(std::abs(basis.determinant()) - 1) < 1e-9);
      double product = 1, before = 1;
      for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) CHECK(std::abs(basis(i, j) - lattice.nearest(basis(i, j))) < 1e-9);
        product *= cost(form, basis.col(i));
        before *= form(i, i).real();
      }
      CHECK(product <= before * (1 + 1e-9));
    }
  }
}

TEST_CASE("choices of lattice points come close to the best one") {
  Random random(3);
  for (const int rotation_order : {4, 6}) {
    const lsgp::PointLattice lattice(rotation_order);
    for (int round = 0; round < 30; ++round) {
      const Eigen::MatrixXcd form = random_form(random, 2);
      const Eigen::VectorXcd wanted = 5 * random_matrix<lsgp::Complex>(random, 2, 1);
      const lsgp::LatticeSearch search(form, {}, lattice);
      const auto nearest = search.nearest(wanted), improved = search.improve(wanted, nearest);
      CHECK(nearest.cost == doctest::Approx(cost(form, nearest.x - wanted)));
      CHECK(improved.cost <= nearest.cost * (1 + 1e-12));
      CHECK(improved.valid());
      double best = INFINITY;
      for (const lsgp::Complex x : points_near(lattice, wanted[0], 6)) {
        for (const lsgp::Complex y : points_near(lattice, wanted[1], 6)) {
          best = std::min(best, cost(form, Eigen::Vector2cd(x, y) - wanted));
        }
      }
      // Of two variables over a Euclidean ring the nearest plane is within a small factor of the best (Babai 1986).
      CHECK(improved.cost <= 2 * best + 1e-12);
    }
  }
}

TEST_CASE("triangles keep an area") {
  const lsgp::PointLattice lattice(4);
  const Eigen::MatrixXcd form = Eigen::MatrixXcd::Identity(2, 2);
  lsgp::MovingTriangle triangle;
  triangle.slope = {Eigen::RowVector2cd(0, 0), Eigen::RowVector2cd(1, 0), Eigen::RowVector2cd(0, 1)};
  const lsgp::LatticeSearch search(form, {triangle}, lattice);
  // The nearest points lie on a line.
  const Eigen::VectorXcd wanted = Eigen::Vector2cd(1.1, lsgp::Complex(0, 0.3));
  CHECK_FALSE(search.nearest(wanted).valid());
  const auto choice = search.improve(wanted, search.nearest(wanted));
  CHECK(choice.valid());
  CHECK((std::conj(choice.x[0]) * choice.x[1]).imag() >= 1);
  CHECK(choice.cost == doctest::Approx(0.1 * 0.1 + 0.7 * 0.7));
}

TEST_CASE("no single step improves an improved choice that keeps all areas") {
  Random random(4);
  int tried = 0;
  for (const int rotation_order : {4, 6}) {
    const lsgp::PointLattice lattice(rotation_order);
    const auto area_of = [&](const lsgp::MovingTriangle& triangle, const Eigen::VectorXcd& x) {
      const lsgp::Complex a = triangle.slope[0] * x, b = triangle.slope[1] * x, c = triangle.slope[2] * x;
      return (std::conj(b - a) * (c - a)).imag() / lattice.cell_area();
    };
    for (int round = 0; round < 40; ++round) {
      constexpr int size = 7;
      const Eigen::MatrixXcd form = random_form(random, size);
      const Eigen::VectorXcd wanted = 4 * random_matrix<lsgp::Complex>(random, size, 1);
      // A fan of triangles around the origin, in the order of where their corners are wanted.
      std::vector<int> order{0, 1, 2, 3, 4, 5, 6};
      std::sort(order.begin(), order.end(), [&](int i, int j) { return std::arg(wanted[i]) < std::arg(wanted[j]); });
      lsgp::Array<lsgp::MovingTriangle> fan;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const int from = order[i], to = order[(i + 1) % order.size()];
        if (!((std::conj(wanted[from]) * wanted[to]).imag() > 0)) continue;
        fan.push_back({{Eigen::RowVectorXcd::Zero(size), Eigen::RowVectorXcd::Unit(size, from),
                        Eigen::RowVectorXcd::Unit(size, to)}});
      }
      const lsgp::LatticeSearch search(form, fan, lattice);
      const auto nearest = search.nearest(wanted), improved = search.improve(wanted, nearest);
      CHECK(improved.cost == doctest::Approx(cost(form, improved.x - wanted)));
      double violation = 0;
      for (const auto& triangle : fan) violation += std::max(0.0, 1 - area_of(triangle, improved.x));
      CHECK(improved.violation == doctest::Approx(violation));
      if (nearest.valid() || !improved.valid()) continue;
      ++tried;
      for (int k = 0; k < size; ++k) {
        for (int turn = 0; turn < rotation_order; ++turn) {
          const Eigen::VectorXcd stepped = improved.x + lattice.unit(turn) * Eigen::VectorXcd::Unit(size, k);
          const bool keeps_areas = std::all_of(
              fan.begin(), fan.end(), [&](const auto& triangle) { return area_of(triangle, stepped) >= 1 - 1e-9; });
          if (keeps_areas) CHECK(cost(form, stepped - wanted) >= improved.cost * (1 - 1e-6));
        }
      }
    }
  }
  CHECK(tried > 10);
}
