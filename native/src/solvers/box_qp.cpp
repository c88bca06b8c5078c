// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_qp.hpp"

#include <Eigen/LU>
#include <vector>

namespace lsgp {

namespace {

struct Step {
  Eigen::VectorXd direction;  // (k) zero at the bounded variables
  double multiplier = 0;      // of the sum
};

// The step to the minimum over the free variables, the others held.
Step step_to_minimum(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& slope, const std::vector<int>& free,
                     bool keep_sum) {
  const int count = static_cast<int>(free.size()), size = count + (keep_sum ? 1 : 0);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right(size);
  right.setZero();
  // The sum's row is scaled like the Hessian so that the elimination's pivots compare.
  const double scale = hessian.diagonal().mean();
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) system(i, j) = hessian(free[i], free[j]);
    if (keep_sum) system(i, count) = system(count, i) = scale;
    right[i] = -slope[free[i]];
  }
  const Eigen::VectorXd solution = system.partialPivLu().solve(right);
  Step step{Eigen::VectorXd::Zero(slope.size()), keep_sum ? solution[count] * scale : 0.0};
  for (int i = 0; i < count; ++i) step.direction[free[i]] = solution[i];
  return step;
}

}  // namespace

Eigen::VectorXd minimize_in_box(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                const Eigen::VectorXd& low, const Eigen::VectorXd& high, bool keep_sum) {
  const int size = static_cast<int>(gradient.size());
  enum class Side : char { free, low, high };
  std::vector<Side> side(size, Side::free);
  for (int i = 0; i < size; ++i) {
    if (low[i] >= high[i]) side[i] = Side::low;  // a fixed variable is never released
  }
  Eigen::VectorXd d = Eigen::VectorXd::Zero(size);
  const int most_changes = 50 * (size + 1);
  for (int change = 0; change < most_changes; ++change) {
    std::vector<int> free;
    for (int i = 0; i < size; ++i) {
      if (side[i] == Side::free) free.push_back(i);
    }
    const Eigen::VectorXd slope = gradient + hessian * d;
    double multiplier = 0;
    if (free.size() > (keep_sum ? 1u : 0u)) {
      const Step step = step_to_minimum(hessian, slope, free, keep_sum);
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
        side[blocking] = step.direction[blocking] < 0 ? Side::low : Side::high;
        d[blocking] = side[blocking] == Side::low ? low[blocking] : high[blocking];
        continue;
      }
      multiplier = step.multiplier;
    } else if (keep_sum && !free.empty()) {
      multiplier = -slope[free[0]];
    }
    // At the minimum over the free variables: release the bound that pulls inwards most.
    const Eigen::VectorXd reduced = (gradient + hessian * d).array() + multiplier;
    int released = -1;
    double pull = 1e-12 * (1 + gradient.cwiseAbs().maxCoeff());
    for (int i = 0; i < size; ++i) {
      if (side[i] == Side::free || low[i] >= high[i]) continue;
      const double inwards = side[i] == Side::low ? -reduced[i] : reduced[i];
      if (inwards > pull) {
        pull = inwards;
        released = i;
      }
    }
    if (released < 0) break;
    side[released] = Side::free;
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
