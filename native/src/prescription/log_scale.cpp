// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/log_scale.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "base/thread_team.hpp"
#include "solvers/box_qp.hpp"
#include "solvers/dense_kernels.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

constexpr int most_newton_steps = 60;
constexpr int most_coarse_steps = 20;       // of these; some 10 to 14 are usual
constexpr double newton_decrement = 1e-20;  // of the objective, a logarithm of order 1
constexpr int most_harmonic_steps = 100;
constexpr double harmonic_residual = 1e-22;  // squared, relative to that of the coarse surface's solution
constexpr double too_small_to_see = 1e-11;   // decreases below the rounding error of the objective
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double ridge = 1e-13;  // relative: cones so close that their Green's functions nearly agree

// log mean e^{2y} + log mean e^{-2y}, weighted, and the contribution of each vertex to the two means, (n, 2).
double log_stretch(const Eigen::VectorXd& weight, const Eigen::VectorXd& y, Eigen::MatrixXd& shares) {
  constexpr double most = 700;                              // e^x is finite up to here
  const double middle = (y.maxCoeff() + y.minCoeff()) / 2;  // cancels
  const Eigen::ArrayXd growth = (2 * (y.array() - middle)).min(most).max(-most).exp();
  shares.resize(y.size(), 2);
  shares.col(0) = weight.array() * growth;
  shares.col(1) = weight.array() / growth;
  return shares.colwise().sum().array().log().sum();
}

// The product with a tall matrix, a few columns at a time: Eigen reads a few rows of all columns at a time, which
// misses the cache.
Eigen::VectorXd tall_product(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factors) {
  constexpr Eigen::Index columns_at_once = 8;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(columns.rows());
  for (Eigen::Index i = 0; i < columns.cols(); i += columns_at_once) {
    const Eigen::Index count = std::min(columns_at_once, columns.cols() - i);
    out.noalias() += columns.middleCols(i, count) * factors.segment(i, count);
  }
  return out;
}

// The part of a weighted Gram matrix that some rows make up; a few rows at a time, which stay in the cache.
Eigen::MatrixXd gram_of_rows(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weight, Eigen::Index first,
                             Eigen::Index end) {
  constexpr Eigen::Index rows_at_once = 512;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  for (Eigen::Index begin = first; begin < end; begin += rows_at_once) {
    const Eigen::Index count = std::min(rows_at_once, end - begin);
    const Eigen::MatrixXd scaled =
        weight.segment(begin, count).cwiseSqrt().asDiagonal() * columns.middleRows(begin, count);
    dense_kernels<double>().add_gram(scaled.data(), static_cast<int>(count), static_cast<int>(columns.cols()),
                                     sum.data());
    checkpoint(static_cast<double>(count * columns.cols() * columns.cols()));
  }
  return sum;
}

// columns^T diag(weight) columns, lower triangle. The rows of each thread's blocks and the order in which these are
// added depend on the size alone.
Eigen::MatrixXd weighted_gram(const Eigen::MatrixXd& columns, const Eigen::VectorXd& weight) {
  constexpr Eigen::Index rows_of_block = 16384, blocks_at_once = 8, rows_at_once = rows_of_block * blocks_at_once;
  const Eigen::Index rows = columns.rows();
  if (rows <= rows_of_block) return gram_of_rows(columns, weight, 0, rows);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  Array<Eigen::MatrixXd> blocks(blocks_at_once);
  for (Eigen::Index begin = 0; begin < rows; begin += rows_at_once) {
    const Eigen::Index left = (rows - begin + rows_of_block - 1) / rows_of_block,
                       count = std::min(left, blocks_at_once);
    team_of_this_call().run_each(static_cast<int>(count), [&](int i) {
      const Eigen::Index first = begin + i * rows_of_block;
      blocks[i] = gram_of_rows(columns, weight, first, std::min(first + rows_of_block, rows));
    });
    for (Eigen::Index i = 0; i < count; ++i) sum += blocks[i];
  }
  return sum;
}

// The update of a Hessian that makes it explain how a step changed the gradient (BFGS).
void learn(Eigen::MatrixXd& hessian, const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
  const Eigen::VectorXd expected = hessian * step;
  const double curvature = step.dot(change), expected_curvature = step.dot(expected);
  if (!(curvature > 0 && expected_curvature > 0)) return;
  hessian += change * (change / curvature).transpose() - expected * (expected / expected_curvature).transpose();
}

// The number of further steps to the minimum, extrapolated from the last two decreases of the objective.
double steps_left(double decrease, double before) {
  return decrease < before ? std::log(newton_decrement / decrease) / std::log(decrease / before) : infinity;
}

// The vertex that fixes the constant: a cone, whose Green's function is then 0, or another vertex on the cuts.
Index ground(const Array<Index>& cones, const CutFactor* factor) {
  if (!cones.empty()) return cones.back();
  return factor != nullptr ? factor->cut_mesh().source[factor->retained().front()] : 0;
}

}  // namespace

// What the prescription minimizes, log mean e^{2y} + log mean e^{-2y}, as a function of the cone curvatures.
class LogScale::Stretch {
 public:
  explicit Stretch(const LogScale& scale) : scale_(scale) {}

  // All that follows is of this log scale.
  double evaluate(const Eigen::VectorXd& y) { return log_stretch(scale_.weight_, y, shares_); }
  Eigen::VectorXd gradient() {
    const Eigen::RowVector2d whole = shares_.colwise().sum();
    shares_.array().rowwise() /= whole.array();
    return 2 * scale_.products(shares_.col(0) - shares_.col(1));
  }
  // After the gradient, as the next one.
  Eigen::MatrixXd hessian() const { return hessian(scale_.green(), shares_.col(0), shares_.col(1)); }
  // That of the same stretch on a coarse surface.
  Eigen::MatrixXd coarse_hessian() const {
    const CoarseGreen& coarse = scale_.coarse_green();
    return hessian(coarse.columns(), coarse.at_nodes(shares_.col(0)), coarse.at_nodes(shares_.col(1)));
  }

 private:
  static Eigen::MatrixXd hessian(const Eigen::MatrixXd& green, const Eigen::VectorXd& growth,
                                 const Eigen::VectorXd& shrinkage) {
    Eigen::MatrixXd means(green.cols(), 2), out = 4 * weighted_gram(green, growth + shrinkage);
    means.col(0) = green.transpose() * growth;
    means.col(1) = green.transpose() * shrinkage;
    out.selfadjointView<Eigen::Lower>().rankUpdate(means, -4);
    out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
    out.diagonal().array() += ridge * out.diagonal().mean();
    return out;
  }

  const LogScale& scale_;
  Eigen::MatrixXd shares_;  // (n, 2) of the area, weighted by e^{2y} and by e^{-2y}
};

LogScale::LogScale(const MetricMesh& surface, const BorderConditions& border, const Array<Index>& cones,
                   const CutFactor* factor)
    : surface_(surface),
      border_(border),
      cones_(cones),
      weight_(surface.geometry.vertex_area / surface.geometry.total_area) {
  is_coarse_ = CoarseGreen::pays(mesh(), cones_);
  require_matrix_memory(mesh().vertex_count(), is_coarse_ ? 0 : cone_count(), GrowsWith::conditions);
  green_.resize(mesh().vertex_count(), 0);
  if (cones.empty() && factor == nullptr) return;
  const PerVertex<char> held = held_with(ground(cones, factor));
  laplace_ = factor != nullptr ? laplace_on_cut(*factor, held) : sparse_laplace(surface, held);
  if (is_coarse_) return;
  LaplaceSolver::Response response = laplace_->solve(border.curvature - geometry().angle_defect, cones);
  without_cones_ = std::move(response.to_right_side);
  green_ = std::move(response.to_impulses);
}

PerVertex<char> LogScale::held_with(Index vertex) const {
  PerVertex<char> held = border_.held;
  if (border_.balanced) held[vertex] = 1;
  return held;
}

const LaplaceSolver& LogScale::laplace() const {
  if (!laplace_) laplace_ = sparse_laplace(surface_, held_with(ground({}, nullptr)));
  return *laplace_;
}

const Eigen::VectorXd& LogScale::without_cones() const {
  if (without_cones_.size() == 0) without_cones_ = laplace().solve(border_.curvature - geometry().angle_defect);
  return without_cones_;
}

const Eigen::MatrixXd& LogScale::green() const {
  if (green_.cols() < cone_count()) {
    require_matrix_memory(mesh().vertex_count(), cone_count(), GrowsWith::conditions);
    green_ = laplace().solve(Eigen::VectorXd::Zero(mesh().vertex_count()), cones_).to_impulses;
  }
  return green_;
}

const CoarseGreen& LogScale::coarse_green() const {
  if (!coarse_green_) {
    BorderConditions border = border_;
    border.held = held_with(ground(cones_, nullptr));
    coarse_green_ = std::make_unique<CoarseGreen>(surface_, border, cones_);
  }
  return *coarse_green_;
}

Eigen::VectorXd LogScale::combine(const Eigen::VectorXd& cone_curvature) const {
  if (!is_coarse_) return tall_product(green_, cone_curvature);
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(mesh().vertex_count());
  right_side(cones_) = cone_curvature;
  return solve(right_side);
}

Eigen::VectorXd LogScale::products(const Eigen::VectorXd& values) const {
  if (!is_coarse_) return green_.transpose() * values;
  return solve(values)(cones_);  // the Laplacian is symmetric
}

Eigen::VectorXd LogScale::solve(const Eigen::VectorXd& right_side) const { return laplace().solve(right_side); }

Eigen::MatrixXd LogScale::solve_columns(const Eigen::MatrixXd& right_sides) const {
  return laplace().solve(right_sides);
}

void LogScale::set_cones(const Array<Index>& vertices) {
  const Index n = surface_.mesh.vertex_count();
  PerVertex<Index> column(n, none);  // of green_
  for (Index i = 0; i < cone_count(); ++i) column[cones_[i]] = i;
  Array<Index> added;
  for (const Index v : vertices) {
    if (column[v] != none) continue;
    column[v] = cone_count() + static_cast<Index>(added.size());
    added.push_back(v);
  }
  require_matrix_memory(n, 2.0 * static_cast<double>(added.size()) + static_cast<double>(vertices.size()),
                        GrowsWith::conditions);
  Eigen::MatrixXd impulses = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(added.size()));
  for (std::size_t i = 0; i < added.size(); ++i) impulses(added[i], static_cast<Eigen::Index>(i)) = 1;
  const Eigen::MatrixXd solved = laplace().solve(impulses);
  Eigen::MatrixXd green(n, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Index from = column[vertices[i]];
    const auto to = static_cast<Eigen::Index>(i);
    if (from < cone_count())
      green.col(to) = this->green().col(from);
    else
      green.col(to) = solved.col(from - cone_count());
  }
  green_ = std::move(green);
  cones_ = vertices;
  is_coarse_ = false;
}

Eigen::VectorXd LogScale::evaluate(const Eigen::VectorXd& cone_curvature) const {
  Eigen::VectorXd y = evaluate_held(cone_curvature);
  y.array() -= weight_.dot(y);
  return y;
}

Eigen::VectorXd LogScale::evaluate_held(const Eigen::VectorXd& cone_curvature) const {
  return without_cones() + combine(cone_curvature);
}

Eigen::VectorXd LogScale::evaluate_held(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const {
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(surface_.mesh.vertex_count());
  for (std::size_t i = 0; i < vertices.size(); ++i) right_side[vertices[i]] += curvature[static_cast<Eigen::Index>(i)];
  return without_cones() + solve(right_side);
}

// On the surface itself by conjugate gradients, with the solution on a coarse one as preconditioner.
Eigen::VectorXd LogScale::harmonic_curvature() const {
  const Index k = cone_count();
  const bool balanced = border_.balanced;
  Eigen::MatrixXd system = Eigen::MatrixXd::Ones(k + balanced, k + balanced);
  if (is_coarse_)
    system.topLeftCorner(k, k) = coarse_green().at_cones();
  else
    system.topLeftCorner(k, k) = green_(cones_, Eigen::seqN(0, k));
  if (balanced) system(k, k) = 0;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(system);
  const auto solve_for = [&](const Eigen::VectorXd& y, double sum) {
    Eigen::VectorXd right = Eigen::VectorXd::Constant(k + balanced, sum);
    right.head(k) = y;
    return Eigen::VectorXd(factor.solve(right).head(k));
  };
  Eigen::VectorXd kappa = solve_for(-without_cones()(cones_), balanced ? required_sum() : 0);
  if (!is_coarse_) return kappa;
  Eigen::VectorXd residual = -evaluate_held(kappa)(cones_), direction = Eigen::VectorXd::Zero(k);
  double first = 0, before = infinity;
  for (int step = 0; step < most_harmonic_steps; ++step) {
    const Eigen::VectorXd change = solve_for(residual, 0);
    const double size = residual.dot(change);
    if (step == 0) first = size;
    if (!(size > harmonic_residual * first)) break;
    direction = change + size / before * direction;
    const Eigen::VectorXd response = combine(direction)(cones_);
    const double length = size / direction.dot(response);
    kappa += length * direction;
    residual -= length * response;
    before = size;
  }
  return kappa;
}

// With many cones a Hessian costs as much as dozens of gradients: while fewer steps remain, it is improved by what the
// steps teach instead. One of a coarse surface is cheap, but where it is not enough, exact ones follow.
Eigen::VectorXd LogScale::least_distortion_curvature(const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                                     Eigen::VectorXd start) const {
  const double gradients_of_hessian = 2 + cone_count() / 20.0;
  const int coarse_steps = is_coarse_ ? most_coarse_steps : 0;
  Eigen::VectorXd kappa = std::move(start);
  Eigen::VectorXd y = evaluate_held(kappa);
  Stretch stretch(*this);
  BoxProgram program(border_.balanced);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd last_gradient, moved;
  double value = stretch.evaluate(y), before = infinity;
  for (int step = 0; step < most_newton_steps; ++step) {
    const Eigen::VectorXd gradient = stretch.gradient();
    Eigen::VectorXd direction;
    double decrease = infinity;
    const auto minimize = [&] {
      direction = program.minimize(gradient, low - kappa, high - kappa);
      decrease = -gradient.dot(direction);
    };
    if (step > 0) {
      learn(hessian, moved, gradient - last_gradient);
      program.set_hessian(hessian);
      minimize();
    }
    const double worth_another = step < coarse_steps ? most_newton_steps : gradients_of_hessian;
    const bool is_fresh = step == 0 || (decrease > newton_decrement &&
                                        (step == coarse_steps || steps_left(decrease, before) > worth_another));
    if (is_fresh) {
      hessian = step < coarse_steps ? stretch.coarse_hessian() : stretch.hessian();
      program.set_hessian(hessian);
      minimize();
    }
    const bool is_visible = decrease > too_small_to_see;
    if (!(decrease > newton_decrement) || (is_fresh && !is_visible && !(decrease < before))) break;
    const Eigen::VectorXd change = combine(direction);
    double length = 1, tried = value;
    for (; length > 1e-6; length /= 2) {
      tried = stretch.evaluate(y + length * change);
      if (!is_visible || tried <= value - 1e-4 * length * decrease) break;
    }
    if (is_visible && !(tried < value)) break;
    moved = length * direction;
    last_gradient = gradient;
    kappa += moved;
    y += length * change;
    value = tried;
    before = decrease;
  }
  return kappa;
}

double LogScale::predicted_l2(const Eigen::VectorXd& log_scale) const {
  constexpr double most = 350;  // so that e^(2 most) and its reciprocal are numbers
  const double middle = (log_scale.maxCoeff() + log_scale.minCoeff()) / 2;  // cancels
  const Eigen::VectorXd factor = (log_scale.array() - middle).min(most).max(-most).exp();
  double growth = 0, shrinkage = 0;
  for (Index h = 0; h < surface_.mesh.halfedge_count(); ++h) {
    const double scale = factor[surface_.mesh.origin(h)] * factor[surface_.mesh.target(h)];
    growth += surface_.geometry.area[h / 3] * scale;
    shrinkage += surface_.geometry.area[h / 3] / scale;
  }
  return std::min(std::sqrt(growth) * std::sqrt(shrinkage) / (3 * surface_.geometry.total_area), largest_l2);
}

double LogScale::lumped_l2(const Eigen::VectorXd& log_scale) const {
  Eigen::MatrixXd shares;
  return std::exp(log_stretch(weight_, log_scale, shares) / 2);
}

LogScale::Variance LogScale::variance() const {
  const Eigen::VectorXd mean = green().transpose() * weight_;
  Variance out{weighted_gram(green(), weight_), {}};
  out.hessian.triangularView<Eigen::StrictlyUpper>() = out.hessian.transpose();
  out.hessian -= mean * mean.transpose();
  out.gradient = green().transpose() * weight_.cwiseProduct(without_cones()) - weight_.dot(without_cones()) * mean;
  return out;
}

}  // namespace lsgp
