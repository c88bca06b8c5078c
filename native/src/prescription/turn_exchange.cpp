// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/turn_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"

namespace lsgp {

bool is_torus(const HalfedgeMesh& mesh) { return mesh.closed() && mesh.genus == 1; }

// A torus whose only cones are one of +1 and one of -1 turns does not exist (Izmestiev, Kusner, Rote, Springborn,
// Sullivan: There is no triangulation of the torus with vertex degrees 5, 6, ..., 6, 7, 2013, theorem 5).
bool is_impossible_on_torus(const Eigen::VectorXi& turns, int rotation_order) {
  if (rotation_order == 1) return false;
  int cones = 0;
  bool coprime = true;
  for (const int t : turns) {
    if (t == 0) continue;
    ++cones;
    coprime = coprime && std::gcd(std::abs(t), rotation_order) == 1;
  }
  return cones == 2 && coprime;
}

TurnExchange::TurnExchange(const HalfedgeMesh& mesh, const LogScale::Variance& variance, TurnBounds bounds,
                           int rotation_order, Eigen::VectorXi turns)
    : torus_(is_torus(mesh)), bounds_(std::move(bounds)), rotation_order_(rotation_order), turns_(std::move(turns)) {
  const double unit = 2 * M_PI / rotation_order;
  hessian_ = unit * unit * variance.hessian;
  slope_ = unit * variance.gradient;
  const double steepest = slope_.cwiseAbs().maxCoeff(), most_curved = hessian_.diagonal().maxCoeff();
  least_gain_ = relative_gain * (steepest + most_curved * (1 + turns_.cwiseAbs().sum()));
  evaluate();
}

bool TurnExchange::allowed(Index i, int step) const {
  return turns_[i] + step >= bounds_.low[i] && turns_[i] + step <= bounds_.high[i];
}

void TurnExchange::reach(int sum) {
  for (int missing = sum - turns_.sum(); missing != 0; missing = sum - turns_.sum()) {
    const int step = missing > 0 ? 1 : -1;
    const auto cost = [&](Index i) { return 2 * gradient_[i] * step + hessian_(i, i); };
    Index best = none;
    for (Index i = 0; i < turns_.size(); ++i) {
      if (allowed(i, step) && (best == none || cost(i) < cost(best))) best = i;
    }
    apply({cost(best), best, none, step});
  }
}

void TurnExchange::leave_impossible(bool keep_sum) {
  if (!torus_ || !is_impossible_on_torus(turns_, rotation_order_)) return;
  const Array<Swap> best = swaps(keep_sum, {}, 1);
  if (!best.empty()) apply(best.front());
}

void TurnExchange::descend(bool keep_sum, const Array<Index>& held) {
  for (Eigen::Index left = most_exchanges(); left > 0; --left) {
    const Array<Swap> best = swaps(keep_sum, held, 1);
    if (best.empty()) return;
    const double before = value_;
    apply(best.front());
    if (value_ < before - least_gain_) continue;
    apply(reversed(best.front()));
    return;
  }
}

void TurnExchange::search(bool keep_sum) {
  descend(keep_sum);
  Eigen::Index left = most_exchanges();
  for (bool lowered = true; lowered && left > 0; --left) {
    lowered = false;
    for (const Swap& swap : swaps(keep_sum, {}, trial_count())) {
      TurnExchange trial = *this;
      trial.apply(swap);
      trial.descend(keep_sum, {swap.first, swap.second});
      trial.descend(keep_sum);
      if (!(trial.value_ < value_ - least_gain_)) continue;
      take_turns_of(trial);
      lowered = true;
      break;
    }
  }
}

void TurnExchange::refine(const LogScale& scale, bool keep_sum) {
  const double unit = 2 * M_PI / rotation_order_;
  Eigen::VectorXd y = scale.evaluate_held(curvature());
  const auto moved = [&](Eigen::VectorXd at, const Swap& swap) {
    at += swap.step * unit * scale.effect(swap.first);
    if (swap.second != none) at -= swap.step * unit * scale.effect(swap.second);
    return at;
  };
  double least = scale.lumped_l2(y);
  int trials = 0;
  struct Trial {
    double stretch;
    Swap swap;
  };
  // The first exchange at some turns that improves on all before is kept; otherwise all of them with their stretch.
  const auto try_at = [&](TurnExchange turns, const Eigen::VectorXd& at, std::size_t count) {
    Array<Trial> tried;
    for (const Swap& swap : turns.swaps(keep_sum, {}, count)) {
      Eigen::VectorXd there = moved(at, swap);
      checkpoint(operations_of_exponential * static_cast<double>(there.size()));
      tried.push_back({scale.lumped_l2(there), swap});
      ++trials;
      if (!(tried.back().stretch < least * (1 - 1e-9))) continue;
      least = tried.back().stretch;
      y = std::move(there);
      turns.apply(swap);
      take_turns_of(turns);
      return Array<Trial>();
    }
    std::stable_sort(tried.begin(), tried.end(), [](const Trial& a, const Trial& b) { return a.stretch < b.stretch; });
    return tried;
  };
  const int most =
      static_cast<int>(std::clamp(stretch_work / static_cast<double>(y.size()),
                                  static_cast<double>(least_stretch_trials), static_cast<double>(most_stretch_trials)));
  while (trials < most) {
    const double before = least;
    Array<Trial> first = try_at(*this, y, first_exchanges);
    if (first.size() > continued_exchanges) first.resize(continued_exchanges);
    for (const Trial& trial : first) {
      TurnExchange turns = *this;
      turns.apply(trial.swap);
      try_at(turns, moved(y, trial.swap), second_exchanges);
      if (least < before || trials >= most) break;
    }
    if (!(least < before)) break;
  }
}

std::size_t TurnExchange::trial_count() const {
  const std::size_t affordable = static_cast<std::size_t>(trial_work / static_cast<double>(hessian_.size()));
  return std::clamp(affordable, least_trials, most_trials);
}

void TurnExchange::evaluate() {
  const Eigen::VectorXd turns = turns_.cast<double>();
  gradient_ = slope_ + hessian_ * turns;
  value_ = turns.dot(slope_ + gradient_);
  checkpoint(static_cast<double>(hessian_.size()));
}

void TurnExchange::apply(const Swap& swap) {
  turns_[swap.first] += swap.step;
  if (swap.second != none) turns_[swap.second] -= swap.step;
  evaluate();
}

void TurnExchange::take_turns_of(const TurnExchange& other) {
  turns_ = other.turns_;
  gradient_ = other.gradient_;
  value_ = other.value_;
}

bool TurnExchange::leads_to_impossible(const Swap& swap) const {
  if (!torus_) return false;
  Eigen::VectorXi moved = turns_;
  moved[swap.first] += swap.step;
  if (swap.second != none) moved[swap.second] -= swap.step;
  return is_impossible_on_torus(moved, rotation_order_);
}

Array<TurnExchange::Swap> TurnExchange::swaps(bool keep_sum, const Array<Index>& held, std::size_t count) const {
  const Index k = static_cast<Index>(turns_.size());
  checkpoint(4.0 * k * k);
  Array<char> is_held(k, 0);
  for (const Index i : held) {
    if (i != none) is_held[i] = 1;
  }
  Array<Swap> all;
  const auto keep_cheapest = [&] {
    std::sort(all.begin(), all.end(), precedes);
    if (all.size() > count) all.resize(count);
  };
  double limit = std::numeric_limits<double>::infinity();  // of the cost of what can be among them
  const auto consider = [&](const Swap& swap) {
    if (swap.cost > limit || leads_to_impossible(swap)) return;
    all.push_back(swap);
    if (count > 1 && all.size() < 8 * count) return;
    keep_cheapest();
    if (all.size() == count) limit = all.back().cost;
  };
  Array<Index> free;
  for (Index i = 0; i < k; ++i) {
    if (!is_held[i]) free.push_back(i);
  }
  std::sort(free.begin(), free.end(), [&](Index i, Index j) { return gradient_[i] < gradient_[j]; });
  const auto cost = [&](Index i, int step) { return 2 * gradient_[i] * step + hessian_(i, i); };
  for (const Index i : free) {
    if (!keep_sum && allowed(i, 1)) consider({cost(i, 1), i, none, 1});
    if (!keep_sum && allowed(i, -1)) consider({cost(i, -1), i, none, -1});
  }
  // No exchange costs less than twice the difference of the gradients, since the Hessian is positive semidefinite.
  for (const Index i : free) {
    if (!allowed(i, 1)) continue;
    for (auto j = free.rbegin(); j != free.rend() && 2 * (gradient_[i] - gradient_[*j]) <= limit; ++j) {
      if (*j == i || !allowed(*j, -1)) continue;
      consider({cost(i, 1) + cost(*j, -1) - 2 * hessian_(i, *j), i, *j, 1});
    }
  }
  keep_cheapest();
  return all;
}

}  // namespace lsgp
