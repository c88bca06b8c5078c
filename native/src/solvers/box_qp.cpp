// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lsgp {

void BoxProgram::set_hessian(Eigen::MatrixXd hessian) {
  hessian_ = std::move(hessian);
  free_.clear();
}

std::vector<int> BoxProgram::free_variables() const {
  std::vector<int> free;
  for (std::size_t i = 0; i < side_.size(); ++i) {
    if (side_[i] == Side::free) free.push_back(static_cast<int>(i));
  }
  return free;
}

void BoxProgram::factorize(const std::vector<int>& free) {
  if (free == free_) return;
  const int count = static_cast<int>(free.size()), size = count + (keep_sum_ ? 1 : 0);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  // The sum's row is scaled like the Hessian so that the elimination's pivots compare.
  const double scale = hessian_.diagonal().mean();
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) system(i, j) = hessian_(free[i], free[j]);
    if (keep_sum_) system(j, count) = system(count, j) = scale;
  }
  factor_.emplace(std::move(system));
  free_ = free;
}

BoxProgram::Step BoxProgram::step_to_minimum(const Eigen::VectorXd& slope, const std::vector<int>& free) {
  factorize(free);
  const int count = static_cast<int>(free.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(factor_->rows());
  for (int i = 0; i < count; ++i) right[i] = -slope[free[i]];
  const Eigen::VectorXd solution = factor_->solve(right);
  Step step{Eigen::VectorXd::Zero(slope.size()), keep_sum_ ? solution[count] * hessian_.diagonal().mean() : 0.0};
  for (int i = 0; i < count; ++i) step.direction[free[i]] = solution[i];
  return step;
}

Eigen::VectorXd BoxProgram::minimize(const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                                     const Eigen::VectorXd& high) {
  constexpr double at_bound = 1e-12;
  const int size = static_cast<int>(gradient.size());
  side_.resize(size, Side::free);
  for (int i = 0; i < size; ++i) {
    const bool is_there = side_[i] == Side::low ? low[i] >= -at_bound : side_[i] == Side::high && high[i] <= at_bound;
    if (!is_there) side_[i] = Side::free;
    if (low[i] >= high[i]) side_[i] = Side::low;  // a fixed variable is never released
  }
  Eigen::VectorXd d = Eigen::VectorXd::Zero(size);
  const int most_changes = 50 * (size + 1);
  for (int change = 0; change < most_changes; ++change) {
    const std::vector<int> free = free_variables();
    const Eigen::VectorXd slope = gradient + hessian_ * d;
    double multiplier = 0;
    if (free.size() > (keep_sum_ ? 1u : 0u)) {
      const Step step = step_to_minimum(slope, free);
      double length = 1;
      int blocking = -1;
      for (const int i : free) {
        const double room = (step.direction[i] < 0 ? low[i] : high[i]) - d[i];
        if (step.direction[i] != 0 && room / step.direction[i] < length) {
          length = std::max(0.0, room / step.direction[i]);
          blocking = i;
        }
      }
      d += length * step.direction;
      if (blocking >= 0) {
        side_[blocking] = step.direction[blocking] < 0 ? Side::low : Side::high;
        d[blocking] = side_[blocking] == Side::low ? low[blocking] : high[blocking];
        continue;
      }
      multiplier = step.multiplier;
    } else if (keep_sum_ && !free.empty()) {
      multiplier = -slope[free[0]];
    }
    // At the minimum over the free variables: release the bound that pulls inwards most.
    const Eigen::VectorXd reduced = (gradient + hessian_ * d).array() + multiplier;
    int released = -1;
    double pull = 1e-12 * (1 + gradient.cwiseAbs().maxCoeff());
    for (int i = 0; i < size; ++i) {
      if (side_[i] == Side::free || low[i] >= high[i]) continue;
      const double inwards = side_[i] == Side::low ? -reduced[i] : reduced[i];
      if (inwards > pull) {
        pull = inwards;
        released = i;
      }
    }
    if (released < 0) break;
    side_[released] = Side::free;
  }
  return d;
}

Eigen::VectorXd nearest_with_sum(const Eigen::VectorXd& low, const Eigen::VectorXd& high, const Eigen::VectorXd& wanted,
                                 double sum) {
  const auto at = [&](double shift) {
    return Eigen::VectorXd((wanted.array() + shift).matrix().cwiseMax(low).cwiseMin(high));
  };
  double below = (low - wanted).minCoeff() - 1, above = (high - wanted).maxCoeff() + 1;
  for (int i = 0; i < 200 && below < above; ++i) {
    const double middle = below + (above - below) / 2;
    if (middle <= below || middle >= above) break;
    (at(middle).sum() < sum ? below : above) = middle;
  }
  return at(above);
}

}  // namespace lsgp
