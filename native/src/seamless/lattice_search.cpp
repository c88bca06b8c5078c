// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/lattice_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/checkpoint.hpp"
#include "plane/predicates.hpp"
#include "solvers/dense_products.hpp"

namespace lsgp {

namespace {

constexpr double lovasz = 0.85;  // an exchange has to shorten a vector to this share
// Exchanges in reducing a basis, by the square of its size: without rounding their number would be below this, as each
// shrinks one of the products of squared lengths, none of which can lose more than the form's range of 1 / ridge.
constexpr int most_exchanges = 200;
// Limit of the steps in improving a choice, by its size; never reached in practice.
constexpr int most_steps = 100;
constexpr double operations_a_part = 10;  // of a triangle's place
constexpr double ridge = 1e-12;           // of the diagonal: translations of the layout may cost nothing
// Weights of missing areas, of the form's median diagonal.
constexpr std::array<double, 6> penalties{0.25, 1, 4, 16, 1e3, 1e6};

// The upper triangular R with R^H R = form.
Eigen::MatrixXcd upper_factor(Eigen::MatrixXcd form) {
  const double size = static_cast<double>(form.rows());
  form.diagonal().array() += ridge * (1 + form.diagonal().real().maxCoeff());
  checkpoint(size * size * size);
  return form.llt().matrixU();
}

}  // namespace

Eigen::MatrixXcd reduce_basis(const Eigen::MatrixXcd& form, const PointLattice& lattice) {
  const Eigen::Index size = form.rows();
  Eigen::MatrixXcd basis = Eigen::MatrixXcd::Identity(size, size);
  if (size == 0) return basis;
  // Column k of r holds basis vector k in orthonormal coordinates, its part across the earlier ones on the diagonal.
  Eigen::MatrixXcd r = upper_factor(form);
  const auto shorten = [&](Eigen::Index k, Eigen::Index by) {
    const Complex multiple = lattice.nearest(r(by, k) / r(by, by));
    if (multiple == 0.0) return;
    r.col(k).head(by + 1) -= multiple * r.col(by).head(by + 1);
    basis.col(k) -= multiple * basis.col(by);
  };
  Eigen::Index exchanges_left = most_exchanges * size * size;
  for (Eigen::Index k = 1; k < size;) {
    checkpoint(4.0 * static_cast<double>(size));
    shorten(k, k - 1);
    if (exchanges_left > 0 && std::norm(r(k, k)) + std::norm(r(k - 1, k)) < lovasz * std::norm(r(k - 1, k - 1))) {
      --exchanges_left;
      basis.col(k).swap(basis.col(k - 1));
      r.col(k).swap(r.col(k - 1));
      // A rotation of rows k - 1 and k makes the columns triangular again.
      const Complex a = r(k - 1, k - 1), b = r(k, k - 1);
      const double length = std::hypot(std::abs(a), std::abs(b));
      const Complex c = a / length, s = b / length;
      const Eigen::RowVectorXcd upper = r.row(k - 1), lower = r.row(k);
      r.row(k - 1) = std::conj(c) * upper + std::conj(s) * lower;
      r.row(k) = -s * upper + c * lower;
      r(k, k - 1) = 0;
      k = std::max<Eigen::Index>(1, k - 1);
    } else {
      checkpoint(8.0 * static_cast<double>(size * k));
      for (Eigen::Index by = k - 1; by-- > 0;) shorten(k, by);
      ++k;
    }
  }
  return basis;
}

LatticeSearch::LatticeSearch(Eigen::MatrixXcd form, const Array<MovingTriangle>& triangles, const PointLattice& lattice)
    : form_(std::move(form)), parts_(form_.rows()), lattice_(lattice), moves_of_triangle_(triangles.size()) {
  if (form_.size() == 0) return;
  const int directions = lattice_.square() ? 4 : 6;
  for (int turn = 0; turn < directions; ++turn) units_.push_back(PointLattice(directions).unit(turn));
  for (int f = 0; f < ssize(triangles); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::RowVectorXcd& slope = triangles[f].slope[c];
      for (Eigen::Index k = 0; k < slope.size(); ++k) {
        if (slope[k] != 0.0) parts_[k].push_back({f, c, slope[k]});
      }
    }
  }
  reduced_ = reduce_basis(form_, lattice_);
  const double size = static_cast<double>(form_.rows());
  inverse_of_reduced_.compute(reduced_);
  checkpoint(size * size * size);
  const Eigen::MatrixXcd pulls = multiplied(form_, reduced_);
  triangular_ = upper_factor(multiplied(reduced_.adjoint(), pulls));
  for (Eigen::Index k = 0; k < form_.rows(); ++k) {
    add_move(Eigen::VectorXcd::Unit(form_.rows(), k), form_.col(k));
    if (reduced_.col(k).cwiseAbs().sum() != 1) add_move(reduced_.col(k), pulls.col(k));
  }
}

void LatticeSearch::add_move(const Eigen::VectorXcd& x, const Eigen::VectorXcd& pull) {
  Move move{{}, pull, std::real(x.dot(pull)), {}, {}};
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] != 0.0) move.x.emplace_back(k, x[k]);
  }
  const Array<std::array<Complex, 3>> all = corners_at(x);
  for (int f = 0; f < ssize(all); ++f) {
    if (all[f][0] == all[f][1] && all[f][1] == all[f][2]) continue;  // only shifted
    move.corners.push_back(all[f]);
    move.triangles.push_back(f);
    moves_of_triangle_[f].emplace_back(static_cast<int>(ssize(moves_)), static_cast<int>(ssize(move.triangles)) - 1);
  }
  moves_.push_back(std::move(move));
}

LatticeSearch::Choice LatticeSearch::nearest(const Eigen::VectorXcd& wanted) const {
  Eigen::VectorXcd rest = triangular_ * inverse_of_reduced_.solve(wanted);
  Choice out;
  out.x = Eigen::VectorXcd::Zero(wanted.size());
  for (Eigen::Index k = wanted.size(); k-- > 0;) {
    checkpoint(8.0 * static_cast<double>(wanted.size()));
    const Complex multiple = lattice_.nearest(rest[k] / triangular_(k, k));
    rest -= multiple * triangular_.col(k);
    out.x += multiple * reduced_.col(k);
  }
  out.cost = std::real((out.x - wanted).dot(form_ * (out.x - wanted)));
  for (const auto& corners : corners_at(out.x)) out.violation += violation(corners);
  return out;
}

Array<std::array<Complex, 3>> LatticeSearch::corners_at(const Eigen::VectorXcd& x) const {
  Array<std::array<Complex, 3>> out(moves_of_triangle_.size(), std::array<Complex, 3>{});
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] == 0.0) continue;
    checkpoint(operations_a_part * static_cast<double>(parts_[k].size()));
    for (const Part& part : parts_[k]) out[part.triangle][part.corner] += part.slope * x[k];
  }
  return out;
}

double LatticeSearch::violation(const std::array<Complex, 3>& corners) const {
  return std::max(0.0, 1 - doubled_area(corners[0], corners[1], corners[2]) / lattice_.cell_area());
}

// What steps change is kept from one to the next, since a step concerns few triangles, and few other steps.
struct LatticeSearch::Descent {
  const LatticeSearch& search;
  Array<std::array<Complex, 3>> corners;  // of the triangles
  Array<double> missing;                  // their violations
  Eigen::VectorXcd away, force;           // from the wanted point, and form * away
  Array<Changes> changes;                 // of the missing area, by each move in each direction
  Array<char> is_stale;                   // whether those have to be computed again
  Array<std::size_t> shared;              // triangles of each move that the step moves

  Descent(const LatticeSearch& owner, const Eigen::VectorXcd& x, const Eigen::VectorXcd& wanted)
      : search(owner),
        corners(owner.corners_at(x)),
        away(x - wanted),
        force(owner.form_ * away),
        changes(owner.moves_.size()),
        is_stale(owner.moves_.size(), 1),
        shared(owner.moves_.size(), 0) {
    for (const auto& triangle : corners) missing.push_back(owner.violation(triangle));
  }

  double cost() const { return std::real(away.dot(force)); }

  const Changes& changes_by(int number) {
    Changes& out = changes[number];
    if (!is_stale[number]) return out;
    is_stale[number] = 0;
    const Move& move = search.moves_[number];
    out.fill(0);
    checkpoint(100.0 * static_cast<double>(search.units_.size() * move.triangles.size()));
    for (std::size_t turn = 0; turn < search.units_.size(); ++turn) {
      for (std::size_t i = 0; i < move.triangles.size(); ++i) {
        const int f = move.triangles[i];
        out[turn] += search.violation(moved(corners[f], search.units_[turn], move.corners[i])) - missing[f];
      }
    }
    return out;
  }

  void step(const Move& move, Complex unit) {
    for (const auto& [k, x] : move.x) away[k] += unit * x;
    force += unit * move.pull;
    std::fill(shared.begin(), shared.end(), 0);
    for (const int f : move.triangles) {
      for (const auto& [number, at] : search.moves_of_triangle_[f]) ++shared[number];
    }
    for (std::size_t i = 0; i < move.triangles.size(); ++i) {
      const int f = move.triangles[i];
      const std::array<Complex, 3> before = std::exchange(corners[f], moved(corners[f], unit, move.corners[i]));
      const double missing_before = std::exchange(missing[f], search.violation(corners[f]));
      for (const auto& [number, at] : search.moves_of_triangle_[f]) {
        if (is_stale[number]) continue;
        const Move& other = search.moves_[number];
        if (!may_update(shared[number], other)) {
          is_stale[number] = 1;
          continue;
        }
        checkpoint(200.0 * static_cast<double>(search.units_.size()));
        for (std::size_t turn = 0; turn < search.units_.size(); ++turn) {
          const Complex by = search.units_[turn];
          changes[number][turn] += search.violation(moved(corners[f], by, other.corners[at])) - missing[f] -
                                   (search.violation(moved(before, by, other.corners[at])) - missing_before);
        }
      }
    }
  }

  // Whether to change what is kept of a move, instead of computing it again, where so many of its triangles change:
  // each takes twice as long. On square lattices areas are multiples of small powers of two, and their sums exact.
  bool may_update(std::size_t changing, const Move& move) const {
    return search.lattice_.square() && 2 * changing < move.triangles.size();
  }

  static std::array<Complex, 3> moved(std::array<Complex, 3> triangle, Complex unit, const std::array<Complex, 3>& by) {
    for (std::size_t c = 0; c < 3; ++c) triangle[c] += unit * by[c];
    return triangle;
  }
};

void LatticeSearch::descend(const Eigen::VectorXcd& wanted, double penalty, Choice& choice) const {
  Descent descent(*this, choice.x, wanted);
  const double least_gain = 1e-9 * (penalty + descent.cost());
  for (Eigen::Index left = most_steps * (1 + choice.x.size()); left > 0; --left) {
    int best = -1;
    Complex best_unit = 0;
    double most = -least_gain;
    for (int number = 0; number < ssize(moves_); ++number) {
      const Move& move = moves_[number];
      const Changes& of_area = descent.changes_by(number);
      Complex slope = 0;
      for (const auto& [k, x] : move.x) slope += std::conj(x) * descent.force[k];
      checkpoint(4.0 * static_cast<double>(move.x.size()));
      for (std::size_t turn = 0; turn < units_.size(); ++turn) {
        const Complex unit = units_[turn];
        const double change = move.cost + 2 * std::real(std::conj(unit) * slope) + penalty * of_area[turn];
        if (change >= most) continue;
        most = change;
        best = number;
        best_unit = unit;
      }
    }
    if (best < 0) break;
    for (const auto& [k, x] : moves_[best].x) choice.x[k] += best_unit * x;
    descent.step(moves_[best], best_unit);
  }
  choice.cost = std::real((choice.x - wanted).dot(form_ * (choice.x - wanted)));
  choice.violation = 0;
  for (const double area : descent.missing) choice.violation += area;
}

LatticeSearch::Choice LatticeSearch::improve(const Eigen::VectorXcd& wanted, Choice choice) const {
  Eigen::VectorXd diagonal = form_.diagonal().real();
  std::nth_element(diagonal.data(), diagonal.data() + diagonal.size() / 2, diagonal.data() + diagonal.size());
  const double unit = diagonal[diagonal.size() / 2];
  Choice least = choice;
  for (const double penalty : penalties) {
    descend(wanted, penalty * unit, choice);
    if (choice.violation < least.violation) least = choice;
    if (choice.valid()) break;
  }
  return least;
}

}  // namespace lsgp
