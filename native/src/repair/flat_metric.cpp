// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/flat_metric.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/thread_team.hpp"
#include "solvers/saddle_point.hpp"
#include "solvers/sparse_assembly.hpp"

namespace lsgp {

namespace {

constexpr double least_inequality = 1e-12;  // slack of a triangle's lengths, of the longest

// A triangle's cotangents; none if it is none.
std::optional<Eigen::Vector3d> cotangents(const Eigen::Vector3d& log_length) {
  const Eigen::Vector3d length = (log_length.array() - log_length.maxCoeff()).exp();
  double a = length[0], b = length[1], c = length[2];
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  if (!(c - (a - b) > least_inequality)) return std::nullopt;
  const double four_areas = std::sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)));
  const Eigen::Vector3d square = length.cwiseAbs2();
  return (square.sum() - 2 * square.array()) / four_areas;
}

// Indices of a triangle are those of its halfedges; an angle has the index of the one opposite.
class FlatMetricSearch {
 public:
  FlatMetricSearch(const MetricMesh& surface, const AngleSums& wanted)
      : mesh_(surface.mesh), geometry_(surface.geometry), wanted_(wanted), edge_(mesh_.halfedge_count()) {
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      const Index twin = mesh_.twin[h];
      edge_[h] = twin == none || h < twin ? edge_count_++ : edge_[twin];
    }
    row_.assign(mesh_.vertex_count(), none);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!wanted.is_free[v]) row_[v] = row_count_++;
    }
    log_length_.resize(edge_count_);
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) log_length_[edge_[h]] = std::log(geometry_.length[h]);
    multiplier_ = Eigen::VectorXd::Zero(row_count_);
  }

  bool find(const StepHook& before_step) {
    const Index most = std::min(most_steps, triangles_measured / mesh_.triangle_count());
    if (most < least_steps) return false;
    State state = measured(log_length_);
    if (!state.is_metric) return false;  // degenerate triangles
    int exact_steps = 0;
    for (Index step = 0; step < most; ++step) {
      before_step();
      const Direction direction = find_direction(state);
      if (!search(direction, state)) return is_exact(state);
      exact_steps += is_exact(state);
      if (is_exact(state) && (-direction.slope < settled * state.energy || exact_steps > most_refining_steps)) break;
    }
    return is_exact(state);
  }

  Geometry found() const {
    Eigen::VectorXd length(mesh_.halfedge_count());
    const double largest = log_length_.maxCoeff();
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) length[h] = std::exp(log_length_[edge_[h]] - largest);
    return geometry_of_lengths(mesh_, std::move(length));
  }

 private:
  static constexpr Index most_steps = 200, triangles_measured = 200000;  // of all steps together
  static constexpr Index least_steps = 15;                               // fewer than it takes
  static constexpr int most_refining_steps = 20;                         // once the sums are right
  static constexpr double exact = 1e-10;                                 // radians
  static constexpr double settled = 1e-3;                                // decrease of the energy, relative
  static constexpr double least_curvature = 1e-3;  // of a triangle's energy, which bounds the steps
  static constexpr double shortest_step = 1e-6;
  static constexpr double penalty_margin = 1.1;

  struct State {
    bool is_metric = true;  // all triangles exist
    PerTriangle<Eigen::Vector3d> cotangent;
    double energy = 0;
    Eigen::VectorXd excess;  // (rows) of the sums of angles
  };
  struct Direction {
    Eigen::VectorXd step;  // (edges)
    double slope;          // of the energy
    double curvature;      // of its model
  };

  static bool is_exact(const State& state) { return state.excess.lpNorm<Eigen::Infinity>() < exact; }

  Eigen::Vector3d rest_cotangent(Index f) const { return 2 * geometry_.half_cotangent.segment<3>(3 * f); }
  Index opposite(Index h) const { return mesh_.origin(prev(h)); }

  State measured(const Eigen::VectorXd& log_length) const {
    State out;
    out.cotangent.resize(mesh_.triangle_count());
    PerTriangle<char> exists(mesh_.triangle_count());
    for_each_at_once(mesh_.triangle_count(), [&](Index f) {
      const Index h = 3 * f;
      const auto found = cotangents({log_length[edge_[h]], log_length[edge_[h + 1]], log_length[edge_[h + 2]]});
      exists[f] = found.has_value();
      if (found) out.cotangent[f] = *found;
    });
    out.is_metric = std::find(exists.begin(), exists.end(), 0) == exists.end();
    if (!out.is_metric) return out;
    out.excess = Eigen::VectorXd::Zero(row_count_);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (row_[v] != none) out.excess[row_[v]] = -wanted_.angle[v];
    }
    for (Index f = 0; f < mesh_.triangle_count(); ++f) {
      const Eigen::Vector3d &c = out.cotangent[f], b = rest_cotangent(f);
      out.energy += (b[0] * (c[1] + c[2]) + b[1] * (c[2] + c[0]) + b[2] * (c[0] + c[1])) / 2 - 1;
      for (int i = 0; i < 3; ++i) {
        const Index row = row_[opposite(3 * f + i)];
        if (row != none) out.excess[row] += std::atan2(1, c[i]);
      }
    }
    return out;
  }

  // The derivatives of the angles by the logarithms of the lengths.
  static Eigen::Matrix3d angle_slopes(const Eigen::Vector3d& c) {
    Eigen::Matrix3d out;
    out << c[1] + c[2], -c[2], -c[1], -c[2], c[2] + c[0], -c[0], -c[1], -c[0], c[0] + c[1];
    return out;
  }

  // The conformal energy of a triangle, 1/2 sum b_i (c_j + c_k) - 1 with its cotangents b at rest and c now (MIPS,
  // Hormann and Greiner 2000): gradient, and the positive part of the Hessian with the angles, times multipliers,
  // added.
  struct Expansion {
    Eigen::Vector3d gradient;
    Eigen::Matrix3d hessian, angle_slopes;
  };
  Expansion expand(Index f, const Eigen::Vector3d& c) const {
    const Eigen::Vector3d b = rest_cotangent(f), sides = Eigen::Vector3d::Constant(b.sum()) - b;
    const Eigen::Vector3d square = 1 + c.array().square();  // -dc_i = square_i dangle_i
    Expansion out;
    out.angle_slopes = angle_slopes(c);
    out.gradient = -out.angle_slopes.transpose() * sides.cwiseProduct(square) / 2;
    out.hessian.setZero();
    Eigen::Vector3d factor = -sides.cwiseProduct(square) / 2;  // of the angles' second derivatives
    for (int i = 0; i < 3; ++i) {
      const Index row = row_[opposite(3 * f + i)];
      if (row != none) factor[i] += multiplier_[row];
      const Eigen::Vector3d slope = out.angle_slopes.row(i);
      out.hessian += sides[i] * c[i] * square[i] * slope * slope.transpose();
    }
    for (int m = 0; m < 3; ++m) {
      const Eigen::Vector3d change = -square.cwiseProduct(out.angle_slopes.col(m));  // of the cotangents
      out.hessian.col(m) += angle_slopes(change).transpose() * factor;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen((out.hessian + out.hessian.transpose()) / 2);
    out.hessian = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least_curvature).asDiagonal() *
                  eigen.eigenvectors().transpose();
    return out;
  }

  Direction find_direction(const State& state) {
    PerTriangle<Expansion> expansions(mesh_.triangle_count());
    for_each_at_once(mesh_.triangle_count(), [&](Index f) { expansions[f] = expand(f, state.cotangent[f]); });
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(edge_count_);
    LowerAssembly<double> assembly(edge_count_, 6 * static_cast<std::size_t>(mesh_.triangle_count()));
    std::vector<Eigen::Triplet<double>> slopes;
    for (Index f = 0; f < mesh_.triangle_count(); ++f) {
      const Expansion& one = expansions[f];
      for (int i = 0; i < 3; ++i) {
        const Index h = 3 * f + i, row = row_[opposite(h)];
        gradient[edge_[h]] += one.gradient[i];
        for (int j = 0; j < 3; ++j) {
          if (j <= i) assembly.add(edge_[h], edge_[3 * f + j], one.hessian(i, j));
          if (row != none) slopes.emplace_back(row, edge_[3 * f + j], one.angle_slopes(i, j));
        }
      }
    }
    Eigen::SparseMatrix<double, Eigen::RowMajor> rows(row_count_, edge_count_);
    rows.setFromTriplets(slopes.begin(), slopes.end());
    // Thin triangles are stiff: unknowns and equations of equal size keep the factorization accurate.
    Eigen::SparseMatrix<double> form = assembly.build();
    const Eigen::VectorXd of_edge = form.diagonal().cwiseSqrt().cwiseInverse();
    form = of_edge.asDiagonal() * form * of_edge.asDiagonal();
    rows = rows * of_edge.asDiagonal();
    Eigen::VectorXd of_row(row_count_);
    for (Index row = 0; row < row_count_; ++row) of_row[row] = 1 / rows.row(row).norm();
    rows = of_row.asDiagonal() * rows;
    const Eigen::VectorXd pull = -of_edge.cwiseProduct(gradient), excess = -of_row.cwiseProduct(state.excess);
    const auto found = minimize_under<double>(form, pull, rows, excess);
    multiplier_ = of_row.cwiseProduct(found.multipliers);
    const double curvature = found.x.dot(form.selfadjointView<Eigen::Lower>() * found.x);
    return {of_edge.cwiseProduct(found.x), -pull.dot(found.x), curvature};
  }

  // Halves the step until the energy plus the penalty for wrong sums falls.
  bool search(const Direction& direction, State& state) {
    const double off = state.excess.lpNorm<1>();
    const double needed = 2 * (direction.slope + direction.curvature / 2);
    if (!is_exact(state)) penalty_ = std::max(penalty_, penalty_margin * needed / off);
    const auto cost = [&](const State& at) { return at.energy + penalty_ * at.excess.lpNorm<1>(); };
    const double before = cost(state), slope = direction.slope - penalty_ * off, rounding = 1e-12 * before;
    for (double length = 1; length > shortest_step; length /= 2) {
      Eigen::VectorXd moved = log_length_ + length * direction.step;
      State tried = measured(moved);
      if (!tried.is_metric || !(cost(tried) <= before + 1e-4 * length * slope + rounding)) continue;
      log_length_ = std::move(moved);
      state = std::move(tried);
      return true;
    }
    return false;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const AngleSums& wanted_;
  PerHalfedge<Index> edge_;
  PerVertex<Index> row_;  // none where any sum will do
  Index edge_count_ = 0, row_count_ = 0;
  Eigen::VectorXd log_length_, multiplier_;
  double penalty_ = 0;
};

}  // namespace

std::optional<Geometry> find_flat_metric(const MetricMesh& surface, const AngleSums& wanted,
                                         const StepHook& before_step) {
  FlatMetricSearch search(surface, wanted);
  if (!search.find(before_step)) return std::nullopt;
  return search.found();
}

}  // namespace lsgp
