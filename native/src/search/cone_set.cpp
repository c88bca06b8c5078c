// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/cone_set.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "solvers/box_qp.hpp"

namespace lsgp {

namespace {

constexpr double reach_step = 0.1, spare_reach = 0.1;
constexpr double ridge = 1e-12;    // relative: cones so close that their effects nearly agree
constexpr double at_bound = 1e-9;  // radians

Array<int> all_places(const Array<int>& sites) {
  Array<int> out(sites.size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

}  // namespace

CurvatureFit fit_curvature(const PlacementProblem& problem, const Array<int>& sites, double reach,
                           const Eigen::MatrixXd& hessian, Eigen::VectorXd start) {
  const int count = static_cast<int>(sites.size());
  const double sum = problem.required_sum;
  CurvatureFit out{Eigen::VectorXd(count), Eigen::VectorXd(count), std::move(start), 0, 0};
  const auto widen = [&](double wider) {
    out.used_reach = wider;
    for (int i = 0; i < count; ++i) {
      out.low[i] = problem.limits.low(sites[i], wider);
      out.high[i] = problem.limits.high(sites[i], wider);
    }
  };
  const auto reaches_sum = [&] {
    return !problem.balanced || (out.low.sum() <= sum + at_bound && sum <= out.high.sum() + at_bound);
  };
  widen(reach);
  if (!reaches_sum()) {
    while (!reaches_sum() && out.used_reach <= widest_reach) widen(out.used_reach + reach_step);
    if (out.used_reach <= widest_reach) {
      widen(out.used_reach + spare_reach);
      out.used_reach = std::min(out.used_reach, widest_reach);
    } else if (count > 0) {  // too few for a map, but more may be added
      out.low = out.low.cwiseMin(sum / count);
      out.high = out.high.cwiseMax(sum / count);
    }
  }
  out.variance = problem.kernel.without_cones();
  if (count == 0) return out;
  out.curvature = problem.balanced ? nearest_with_sum(out.low, out.high, out.curvature, sum)
                                   : out.curvature.cwiseMax(out.low).cwiseMin(out.high).eval();
  const Eigen::MatrixXd form = with_ridge(hessian);
  const Eigen::VectorXd gradient = problem.kernel.gradient()(sites);
  BoxProgram program(problem.balanced);
  program.set_hessian(form);
  out.curvature += program.minimize(gradient + form * out.curvature, out.low - out.curvature, out.high - out.curvature);
  out.variance += 2 * gradient.dot(out.curvature) + out.curvature.dot(form * out.curvature);
  return out;
}

double PlacementProblem::mean_price(const Array<int>& sites) const {
  return sites.empty() ? 0 : price(sites).sum() / cone_count(sites);
}

Array<int> CurvatureFit::free_places() const {
  Array<int> free;
  for (int i = 0; i < curvature.size(); ++i) {
    if (curvature[i] > low[i] + at_bound && curvature[i] < high[i] - at_bound) free.push_back(i);
  }
  return free;
}

double mean_slope(const CurvatureFit& fit, const Array<int>& sites, const Eigen::VectorXd& slope) {
  Array<int> at = fit.free_places();
  if (at.empty()) at = all_places(sites);
  double sum = 0;
  for (const int i : at) sum += slope[sites[i]] / static_cast<double>(at.size());
  return sum;
}

Eigen::MatrixXd with_ridge(const Eigen::MatrixXd& hessian) {
  Eigen::MatrixXd out = (hessian + hessian.transpose()) / 2;
  out.diagonal().array() += ridge * out.diagonal().mean();
  return out;
}

int PlacementProblem::cone_count(const Array<int>& sites) const {
  int count = 0;
  for (const int site : sites) count += kernel.sites()[site].cones();
  return count;
}

void ConeSet::add(const Array<int>& sites) {
  const Eigen::Index before = ssize(sites_), added = ssize(sites);
  require_matrix_memory(problem_->kernel.site_count(), static_cast<double>(before + added), GrowsWith::conditions);
  for (const int site : sites) columns_.push_back(problem_->kernel.column(site));
  sites_.insert(sites_.end(), sites.begin(), sites.end());
  fit_.curvature.conservativeResize(before + added);
  fit_.curvature.tail(added).setZero();
  fit();
}

void ConeSet::remove(int place) {
  const Eigen::Index after = ssize(sites_) - 1 - place;
  fit_.curvature.segment(place, after) = fit_.curvature.tail(after).eval();
  sites_.erase(sites_.begin() + place);
  columns_.erase(columns_.begin() + place);
  fit_.curvature.conservativeResize(ssize(sites_));
  fit();
}

void ConeSet::fit() {
  const Eigen::Index count = ssize(sites_);
  Eigen::MatrixXd hessian(count, count);
  for (Eigen::Index i = 0; i < count; ++i) hessian.col(i) = (*columns_[i])(sites_);
  fit_ = fit_curvature(*problem_, sites_, reach_, hessian, std::move(fit_.curvature));
}

Array<int> ConeSet::places_that_respond() const {
  Array<int> free = fit_.free_places();
  return free.empty() && problem_->balanced ? all_places(sites_) : free;
}

// The inverse of the conditions for the least variance over the free curvatures, with the multiplier of their sum.
Eigen::MatrixXd ConeSet::inverse_over(const Array<int>& free) const {
  const int count = static_cast<int>(free.size()), size = count + problem_->balanced;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) system(i, j) = (*columns_[free[j]])[sites_[free[i]]];
    if (problem_->balanced) system(i, count) = system(count, i) = 1;
  }
  if (count > 0) system.topLeftCorner(count, count).diagonal().array() += ridge * system.diagonal().mean();
  return system.partialPivLu().inverse();
}

// The first cone of a closed surface takes up all its curvature; if that is 0, it is one end of a dipole.
Eigen::VectorXd ConeSet::first_gains() const {
  const LogScaleVariance& kernel = problem_->kernel;
  const double sum = problem_->required_sum;
  if (sum == 0) {
    const Eigen::ArrayXd slope = kernel.gradient().array() - kernel.gradient().mean();
    return slope.square() / kernel.diagonal().array().max(kernel.diagonal().mean() * 1e-3);
  }
  return -2 * sum * kernel.gradient() - sum * sum * kernel.diagonal();
}

ConeSet::Explained ConeSet::explain() const {
  Explained out{Eigen::VectorXd::Zero(problem_->kernel.site_count()), places_that_respond(), {}, {}};
  const int count = static_cast<int>(out.free.size());
  if (count == 0) return out;
  Eigen::MatrixXd coupling(out.by_all.size(), count + problem_->balanced);
  for (int i = 0; i < count; ++i) coupling.col(i) = *columns_[out.free[i]];
  if (problem_->balanced) coupling.col(count).setOnes();
  const Eigen::MatrixXd inverse = inverse_over(out.free);
  out.responses = coupling * inverse;
  out.by_all = coupling.cwiseProduct(out.responses).rowwise().sum();
  out.inverse = inverse.diagonal();
  return out;
}

Eigen::VectorXd ConeSet::explained() const {
  constexpr Eigen::Index rows_at_once = 1024;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(problem_->kernel.site_count());
  const Array<int> free = places_that_respond();
  const Eigen::Index count = static_cast<Eigen::Index>(free.size());
  if (count == 0) return out;
  const Eigen::MatrixXd inverse = inverse_over(free);
  for (Eigen::Index begin = 0; begin < out.size(); begin += rows_at_once) {
    const Eigen::Index rows = std::min(rows_at_once, out.size() - begin);
    Eigen::MatrixXd coupling = Eigen::MatrixXd::Ones(rows, inverse.rows());
    for (Eigen::Index i = 0; i < count; ++i) coupling.col(i) = columns_[free[i]]->segment(begin, rows);
    out.segment(begin, rows) = coupling.cwiseProduct(coupling * inverse).rowwise().sum();
    checkpoint(static_cast<double>(rows * count * count));
  }
  return out;
}

Eigen::VectorXd ConeSet::Explained::without(int place) const {
  const auto found = std::find(free.begin(), free.end(), place);
  if (found == free.end()) return by_all;
  const Eigen::Index i = found - free.begin();
  return by_all - responses.col(i).cwiseAbs2() / inverse[i];
}

Eigen::VectorXd ConeSet::gains(const Eigen::VectorXd& explained) const {
  const LogScaleVariance& kernel = problem_->kernel;
  if (kernel.site_count() == 0) return {};
  if (sites_.empty() && problem_->balanced) return first_gains();
  Eigen::VectorXd slope = -kernel.gradient();
  for (std::size_t i = 0; i < columns_.size(); ++i)
    slope -= fit_.curvature[static_cast<Eigen::Index>(i)] * *columns_[i];
  if (problem_->balanced) slope.array() -= mean_slope(fit_, sites_, slope);
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
  Eigen::VectorXd out = Eigen::VectorXd::Zero(fit_.curvature.size());
  const Eigen::MatrixXd inverse = inverse_over(all_places(sites_));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = fit_.curvature[i] * fit_.curvature[i] / std::max(inverse(i, i), 1e-300);
  }
  return out;
}

}  // namespace lsgp
