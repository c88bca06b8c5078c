// SPDX-License-Identifier: GPL-3.0-or-later
// Exchanges of turns between cones, that is of multiples of a lattice's turn, which lower the predicted distortion.
#pragma once

#include <Eigen/Core>
#include <tuple>

#include "base/array.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

// Bounds of the turns a cone may take away.
struct TurnBounds {
  Eigen::VectorXi low, high;
};

bool is_torus(const HalfedgeMesh& mesh);
// Whether no torus has cones with these multiples of the turn 2 pi / rotation_order.
bool is_impossible_on_torus(const Eigen::VectorXi& turns, int rotation_order);

// The quadratic form var(turns) and its exchanges.
class TurnExchange {
 public:
  TurnExchange(const HalfedgeMesh& mesh, const LogScale::Variance& variance, TurnBounds bounds, int rotation_order,
               Eigen::VectorXi turns);

  bool allowed(Index i, int step) const;

  // Single steps toward a sum of turns within the bounds, the cheapest first.
  void reach(int sum);

  // Rounding may have led to turns that no torus has. Exchanges never lead there, so the cheapest one leads away.
  void leave_impossible(bool keep_sum);

  // The best exchange of one turn between two cones, or where the sum is free between a cone and nothing, until none
  // lowers the variance.  `held` cones stay.
  void descend(bool keep_sum, const Array<Index>& held = {});

  // Descents stop where two exchanges at once are needed. From there each of the cheapest exchanges is made in turn
  // and held while the others follow.
  void search(bool keep_sum);

  // The variance underrates large scales. The exchanges with the least increase of the variance, and pairs of them, are
  // judged by the predicted stretch.
  void refine(const LogScale& scale, bool keep_sum);

  const Eigen::VectorXi& turns() const { return turns_; }
  Eigen::VectorXd curvature() const { return turns_.cast<double>() * (2 * M_PI / rotation_order_); }

 private:
  // Relative to the largest terms of the variance: well above their rounding error, so that an exchange and its reverse
  // never both seem to gain.
  static constexpr double relative_gain = 1e-12;
  static constexpr double operations_of_exponential = 40;
  static constexpr std::size_t least_trials = 2, most_trials = 50;
  static constexpr double trial_work = 2e6;  // entries of the Hessian times trials
  static constexpr int least_stretch_trials = 12, most_stretch_trials = 200;
  static constexpr double stretch_work = 2.5e5;  // vertices times trials
  static constexpr std::size_t first_exchanges = 25, continued_exchanges = 5, second_exchanges = 15;

  // A trial looks at the whole Hessian once a step.
  std::size_t trial_count() const;

  // One turn more at a cone, and one less at another where the sum is kept.
  struct Swap {
    double cost;  // the change of the variance
    Index first, second;
    int step;
  };

  static Swap reversed(const Swap& swap) { return {-swap.cost, swap.first, swap.second, -swap.step}; }

  // A bound that no descent has reached: each cone is exchanged back and forth a few times.
  Eigen::Index most_exchanges() const { return 100 + 20 * turns_.size(); }

  // Computed from the turns alone, so that compared values do not depend on the sequence of exchanges.
  void evaluate();

  void apply(const Swap& swap);

  void take_turns_of(const TurnExchange& other);

  bool leads_to_impossible(const Swap& swap) const;

  // Whether one is to be tried before another: the cheaper one, or the one of cones that come first.
  static bool precedes(const Swap& a, const Swap& b) {
    return std::tie(a.cost, a.first, a.second, a.step) < std::tie(b.cost, b.first, b.second, b.step);
  }

  // The cheapest possible ones, in order.
  Array<Swap> swaps(bool keep_sum, const Array<Index>& held, std::size_t count) const;

  bool torus_;
  TurnBounds bounds_;
  int rotation_order_;
  Eigen::VectorXi turns_;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd slope_;     // half the derivative at no turns
  Eigen::VectorXd gradient_;  // the same at the present ones
  double value_ = 0;          // the variance less that of no turns
  double least_gain_ = 0;     // distinguishable from rounding
};

}  // namespace lsgp
