// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/lattice_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/checkpoint.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

constexpr double lovasz = 0.85;  // an exchange has to shorten a vector to this share
// Exchanges in reducing a basis, by the square of its size: without rounding their number would be below this, as each
// shrinks one of the products of squared lengths, none of which can lose more than the form's range of 1 / ridge.
constexpr int most_exchanges = 200;
// Limit of the steps in improving a choice, by its size; never reached in practice.
constexpr int most_steps = 100;
constexpr double ridge = 1e-12;  // of the diagonal: translations of the layout may cost nothing
// Weights of missing areas, of the form's median diagonal.
constexpr std::array<double, 6> penalties{0.25, 1, 4, 16, 1e3, 1e6};

// The upper triangular R with R^H R = form.
Eigen::MatrixXcd upper_factor(Eigen::MatrixXcd form) {
  form.diagonal().array() += ridge * (1 + form.diagonal().real().maxCoeff());
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

LatticeSearch::LatticeSearch(Eigen::MatrixXcd form, Array<MovingTriangle> triangles, const PointLattice& lattice)
    : form_(std::move(form)), triangles_(std::move(triangles)), lattice_(lattice) {
  if (form_.size() == 0) return;
  reduced_ = reduce_basis(form_, lattice_);
  triangular_ = upper_factor(reduced_.adjoint() * form_ * reduced_);
  const auto add_move = [&](const Eigen::VectorXcd& x) {
    Move move{x, form_ * x, 0, {}, {}};
    move.cost = std::real(x.dot(move.pull));
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      std::array<Complex, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = (triangles_[f].slope[c] * x).value();
      if (corners[0] == corners[1] && corners[1] == corners[2]) continue;  // only shifted
      move.corners.push_back(corners);
      move.triangles.push_back(static_cast<int>(f));
    }
    moves_.push_back(std::move(move));
  };
  for (Eigen::Index k = 0; k < form_.rows(); ++k) {
    add_move(Eigen::VectorXcd::Unit(form_.rows(), k));
    const Eigen::VectorXcd reduced = reduced_.col(k);
    if (reduced.cwiseAbs().sum() != 1) add_move(reduced);
  }
}

LatticeSearch::Choice LatticeSearch::nearest(const Eigen::VectorXcd& wanted) const {
  Eigen::VectorXcd rest = triangular_ * reduced_.partialPivLu().solve(wanted);
  Choice out;
  out.x = Eigen::VectorXcd::Zero(wanted.size());
  for (Eigen::Index k = wanted.size(); k-- > 0;) {
    const Complex multiple = lattice_.nearest(rest[k] / triangular_(k, k));
    rest -= multiple * triangular_.col(k);
    out.x += multiple * reduced_.col(k);
  }
  out.cost = std::real((out.x - wanted).dot(form_ * (out.x - wanted)));
  for (const auto& corners : corners_at(out.x)) out.violation += violation(corners);
  return out;
}

Array<std::array<Complex, 3>> LatticeSearch::corners_at(const Eigen::VectorXcd& x) const {
  Array<std::array<Complex, 3>> out(triangles_.size());
  for (std::size_t f = 0; f < triangles_.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) out[f][c] = (triangles_[f].slope[c] * x).value();
  }
  return out;
}

double LatticeSearch::violation(const std::array<Complex, 3>& corners) const {
  return std::max(0.0, 1 - doubled_area(corners[0], corners[1], corners[2]) / lattice_.cell_area());
}

void LatticeSearch::descend(const Eigen::VectorXcd& wanted, double penalty, Choice& choice) const {
  Array<std::array<Complex, 3>> corners = corners_at(choice.x);
  Array<double> missing;
  for (const auto& triangle : corners) missing.push_back(violation(triangle));
  Eigen::VectorXcd away = choice.x - wanted;
  const int directions = lattice_.square() ? 4 : 6;
  const PointLattice units(directions);
  const double least_gain = 1e-9 * (penalty + std::real(away.dot(form_ * away)));
  for (Eigen::Index left = most_steps * (1 + choice.x.size()); left > 0; --left) {
    const Move* best = nullptr;
    Complex best_unit = 0;
    double most = -least_gain;
    for (const Move& move : moves_) {
      checkpoint(static_cast<double>(4 * away.size()) +
                 100.0 * directions * static_cast<double>(move.triangles.size()));
      const Complex slope = move.pull.dot(away);  // conj(pull) . away
      for (int turn = 0; turn < directions; ++turn) {
        const Complex unit = units.unit(turn);
        double change = move.cost + 2 * std::real(std::conj(unit) * slope);
        for (std::size_t i = 0; i < move.triangles.size(); ++i) {
          std::array<Complex, 3> moved = corners[move.triangles[i]];
          for (std::size_t c = 0; c < 3; ++c) moved[c] += unit * move.corners[i][c];
          change += penalty * (violation(moved) - missing[move.triangles[i]]);
        }
        if (change >= most) continue;
        most = change;
        best = &move;
        best_unit = unit;
      }
    }
    if (!best) break;
    choice.x += best_unit * best->x;
    away += best_unit * best->x;
    for (std::size_t i = 0; i < best->triangles.size(); ++i) {
      std::array<Complex, 3>& moved = corners[best->triangles[i]];
      for (std::size_t c = 0; c < 3; ++c) moved[c] += best_unit * best->corners[i][c];
      missing[best->triangles[i]] = violation(moved);
    }
  }
  choice.cost = std::real(away.dot(form_ * away));
  choice.violation = 0;
  for (const double area : missing) choice.violation += area;
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
