// SPDX-License-Identifier: GPL-3.0-or-later
#include "cone_set.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "solvers/box_qp.hpp"

namespace lsgp {

namespace {

constexpr double reach_step = 0.1, spare_reach = 0.1;
constexpr double ridge = 1e-12;    // relative: cones so close that their effects nearly agree
constexpr double at_bound = 1e-9;  // radians

}  // namespace

int ConeSet::cone_count() const {
  int count = 0;
  for (const int site : sites_) count += problem_->kernel.sites()[site].cones();
  return count;
}

void ConeSet::add(int site) {
  const Eigen::VectorXd& column = problem_->kernel.column(site);
  columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
  columns_.col(columns_.cols() - 1) = column;
  sites_.push_back(site);
  curvature_.conservativeResize(columns_.cols());
  curvature_[columns_.cols() - 1] = 0;
  fit();
}

void ConeSet::remove(int place) {
  const Eigen::Index after = columns_.cols() - 1 - place;
  columns_.middleCols(place, after) = columns_.rightCols(after).eval();
  columns_.conservativeResize(Eigen::NoChange, columns_.cols() - 1);
  curvature_.segment(place, after) = curvature_.tail(after).eval();
  curvature_.conservativeResize(columns_.cols());
  sites_.erase(sites_.begin() + place);
  fit();
}

void ConeSet::fit() {
  const int count = static_cast<int>(sites_.size());
  const double sum = problem_->required_sum;
  // Moved in: resizing frees what is there before it asks for more.
  low_ = Eigen::VectorXd(count);
  high_ = Eigen::VectorXd(count);
  const auto widen = [&](double reach) {
    used_reach_ = reach;
    for (int i = 0; i < count; ++i) {
      low_[i] = problem_->limits.low(sites_[i], reach);
      high_[i] = problem_->limits.high(sites_[i], reach);
    }
  };
  const auto reaches_sum = [&] {
    return !problem_->balanced || (low_.sum() <= sum + at_bound && sum <= high_.sum() + at_bound);
  };
  widen(reach_);
  if (!reaches_sum()) {
    while (!reaches_sum() && used_reach_ <= widest_reach) widen(used_reach_ + reach_step);
    if (used_reach_ <= widest_reach) {
      widen(used_reach_ + spare_reach);
      used_reach_ = std::min(used_reach_, widest_reach);
    } else if (count > 0) {  // no cones to unwrap with, but others may join them
      low_ = low_.cwiseMin(sum / count);
      high_ = high_.cwiseMax(sum / count);
    }
  }
  const VarianceKernel& kernel = problem_->kernel;
  variance_ = kernel.without_cones();
  if (count == 0) return;
  curvature_ = problem_->balanced ? nearest_with_sum(low_, high_, curvature_, sum)
                                  : curvature_.cwiseMax(low_).cwiseMin(high_).eval();
  Eigen::MatrixXd hessian(count, count);
  Eigen::VectorXd gradient(count);
  for (int i = 0; i < count; ++i) {
    gradient[i] = kernel.gradient()[sites_[i]];
    for (int j = 0; j < count; ++j) hessian(i, j) = columns_(sites_[i], j);
  }
  hessian = ((hessian + hessian.transpose()) / 2).eval();
  hessian.diagonal().array() += ridge * hessian.diagonal().mean();
  BoxProgram program(problem_->balanced);
  program.set_hessian(hessian);
  curvature_ += program.minimize(gradient + hessian * curvature_, low_ - curvature_, high_ - curvature_);
  variance_ += 2 * gradient.dot(curvature_) + curvature_.dot(hessian * curvature_);
}

std::vector<int> ConeSet::free_places() const {
  std::vector<int> free, all;
  for (int i = 0; i < curvature_.size(); ++i) {
    all.push_back(i);
    if (curvature_[i] > low_[i] + at_bound && curvature_[i] < high_[i] - at_bound) free.push_back(i);
  }
  return free.empty() && problem_->balanced ? all : free;
}

// The inverse of the conditions for the least variance over the free curvatures, with the multiplier of their sum.
Eigen::MatrixXd ConeSet::inverse_over(const std::vector<int>& free) const {
  const int count = static_cast<int>(free.size()), size = count + problem_->balanced;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) system(i, j) = columns_(sites_[free[i]], free[j]);
    if (problem_->balanced) system(i, count) = system(count, i) = 1;
  }
  if (count > 0) system.topLeftCorner(count, count).diagonal().array() += ridge * system.diagonal().mean();
  return system.partialPivLu().inverse();
}

// The first cone of a closed surface takes up all its curvature; where that is none, it is one end of a dipole.
Eigen::VectorXd ConeSet::first_gains() const {
  const VarianceKernel& kernel = problem_->kernel;
  const double sum = problem_->required_sum;
  if (sum == 0) {
    const Eigen::ArrayXd slope = kernel.gradient().array() - kernel.gradient().mean();
    return slope.square() / kernel.diagonal().array().max(kernel.diagonal().mean() * 1e-3);
  }
  return -2 * sum * kernel.gradient() - sum * sum * kernel.diagonal();
}

ConeSet::Explained ConeSet::explain() const {
  Explained out{Eigen::VectorXd::Zero(columns_.rows()), free_places(), {}, {}};
  const int count = static_cast<int>(out.free.size());
  if (count == 0) return out;
  Eigen::MatrixXd coupling(columns_.rows(), count + problem_->balanced);
  for (int i = 0; i < count; ++i) coupling.col(i) = columns_.col(out.free[i]);
  if (problem_->balanced) coupling.col(count).setOnes();
  const Eigen::MatrixXd inverse = inverse_over(out.free);
  out.responses = coupling * inverse;
  out.by_all = coupling.cwiseProduct(out.responses).rowwise().sum();
  out.inverse = inverse.diagonal();
  return out;
}

Eigen::VectorXd ConeSet::Explained::without(int place) const {
  const auto found = std::find(free.begin(), free.end(), place);
  if (found == free.end()) return by_all;
  const Eigen::Index i = found - free.begin();
  return by_all - responses.col(i).cwiseAbs2() / inverse[i];
}

Eigen::VectorXd ConeSet::gains(const Eigen::VectorXd& explained) const {
  if (sites_.empty() && problem_->balanced) return first_gains();
  const VarianceKernel& kernel = problem_->kernel;
  Eigen::VectorXd slope = -kernel.gradient() - columns_ * curvature_;
  if (problem_->balanced) {
    const std::vector<int> free = free_places();
    double multiplier = 0;
    for (const int i : free) multiplier += slope[sites_[i]] / static_cast<double>(free.size());
    slope.array() -= multiplier;
  }
  const double least = std::max(kernel.diagonal_error() / 2, 1e-12 * kernel.diagonal().mean());
  Eigen::VectorXd gains(kernel.site_count());
  for (int i = 0; i < kernel.site_count(); ++i) {
    const double d = std::max(kernel.diagonal()[i] - explained[i], least);
    const double t = std::clamp(slope[i] / d, problem_->limits.low(i, reach_), problem_->limits.high(i, reach_));
    gains[i] = 2 * t * slope[i] - t * t * d;
  }
  return gains;
}

Eigen::VectorXd ConeSet::losses() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(curvature_.size());
  std::vector<int> all(sites_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const Eigen::MatrixXd inverse = inverse_over(all);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = curvature_[i] * curvature_[i] / std::max(inverse(i, i), 1e-300);
  }
  return out;
}

}  // namespace lsgp
