// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lsgp {

namespace {

constexpr double at_bound = 1e-12;
constexpr int most_pivoted_singly = 8;       // variables
constexpr int most_rounds = 100;             // of block pivoting, a factorization each; some 5 to 10 is usual
constexpr int large = 64;                    // variables
constexpr int most_changes_when_large = 30;  // of single sides, a factorization each
constexpr int spare_rounds = 3;              // without a decrease in the number of infeasible variables

}  // namespace

void BoxProgram::set_hessian(Eigen::MatrixXd hessian) {
  hessian_ = std::move(hessian);
  free_.clear();
  block_free_.clear();
  block_.reset();
}

Array<int> BoxProgram::free_variables() const {
  Array<int> free;
  for (std::size_t i = 0; i < side_.size(); ++i) {
    if (side_[i] == Side::free) free.push_back(static_cast<int>(i));
  }
  return free;
}

void BoxProgram::factorize(const Array<int>& free) {
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

BoxProgram::Step BoxProgram::step_to_minimum(const Eigen::VectorXd& slope, const Array<int>& free) {
  factorize(free);
  const int count = static_cast<int>(free.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(factor_->rows());
  for (int i = 0; i < count; ++i) right[i] = -slope[free[i]];
  const Eigen::VectorXd solution = factor_->solve(right);
  Step step{Eigen::VectorXd::Zero(slope.size()), keep_sum_ ? solution[count] * hessian_.diagonal().mean() : 0.0};
  for (int i = 0; i < count; ++i) step.direction[free[i]] = solution[i];
  return step;
}

bool BoxProgram::factorize_block(const Array<int>& free) {
  if (block_ && free == block_free_) return true;
  block_ = DenseCholesky<double>::factored(hessian_(free, free));
  block_free_ = free;
  if (!block_) return false;
  block_ones_ = block_->solve(Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(free.size()), 1));
  return true;
}

// Solves for the free variables with the others at their bounds, and changes the side of all infeasible ones: free ones
// out of bounds, bounded ones whose multiplier has the wrong sign. If their number does not decrease for some rounds,
// only the last one is changed until it does, which prevents cycles.
std::optional<Eigen::VectorXd> BoxProgram::pivot_blocks(const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                                                        const Eigen::VectorXd& high) {
  const int size = static_cast<int>(gradient.size());
  for (int i = 0; i < size; ++i) {
    side_[i] = low[i] >= -at_bound ? Side::low : high[i] <= at_bound ? Side::high : Side::free;
  }
  const double pull = at_bound * (1 + gradient.cwiseAbs().maxCoeff());
  int fewest = size + 1, spare = spare_rounds;
  for (int round = 0; round < most_rounds; ++round) {
    const Array<int> free = free_variables();
    if (keep_sum_ && free.empty()) return std::nullopt;
    Eigen::VectorXd d = Eigen::VectorXd::Zero(size);
    for (int i = 0; i < size; ++i) {
      if (side_[i] != Side::free) d[i] = side_[i] == Side::low ? low[i] : high[i];
    }
    double multiplier = 0;
    if (!free.empty()) {
      if (!factorize_block(free)) return std::nullopt;
      const Eigen::VectorXd slope = gradient + hessian_ * d;
      Eigen::VectorXd solution = block_->solve(-slope(free));
      if (keep_sum_) {
        multiplier = (solution.sum() + d.sum()) / block_ones_.sum();
        solution -= multiplier * block_ones_;
      }
      d(free) = solution;
    }
    const Eigen::VectorXd reduced = (gradient + hessian_ * d).array() + multiplier;
    Array<std::pair<int, Side>> wrong;
    for (int i = 0; i < size; ++i) {
      if (side_[i] == Side::free) {
        if (d[i] < low[i] - at_bound) wrong.emplace_back(i, Side::low);
        if (d[i] > high[i] + at_bound) wrong.emplace_back(i, Side::high);
      } else if (low[i] < high[i] && (side_[i] == Side::low ? -reduced[i] : reduced[i]) > pull) {
        wrong.emplace_back(i, Side::free);
      }
    }
    if (wrong.empty()) return d.cwiseMax(low).cwiseMin(high).eval();
    const int count = static_cast<int>(wrong.size());
    if (count < fewest) {
      fewest = count;
      spare = spare_rounds;
    } else if (--spare < 0) {
      wrong.erase(wrong.begin(), wrong.end() - 1);
    }
    for (const auto& [i, side] : wrong) side_[i] = side;
  }
  return std::nullopt;
}

Eigen::VectorXd BoxProgram::minimize(const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                                     const Eigen::VectorXd& high) {
  const int size = static_cast<int>(gradient.size());
  side_.resize(size, Side::free);
  if (size > most_pivoted_singly) {
    if (std::optional<Eigen::VectorXd> found = pivot_blocks(gradient, low, high)) return *found;
  }
  for (int i = 0; i < size; ++i) {
    const bool is_there = side_[i] == Side::low ? low[i] >= -at_bound : side_[i] == Side::high && high[i] <= at_bound;
    if (!is_there) side_[i] = Side::free;
    if (low[i] >= high[i]) side_[i] = Side::low;  // a fixed variable is never released
  }
  Eigen::VectorXd d = Eigen::VectorXd::Zero(size);
  const int most_changes = size > large ? most_changes_when_large : 50 * (size + 1);
  for (int change = 0; change < most_changes; ++change) {
    const Array<int> free = free_variables();
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
    // At the minimum over the free variables: release the bound with the largest multiplier of the wrong sign.
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
