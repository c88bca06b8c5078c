// SPDX-License-Identifier: GPL-3.0-or-later
// Exchanges of turns between cones, that is of multiples of a lattice's turn, which lower the predicted distortion.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

// Bounds of the turns a cone may take away.
struct TurnBounds {
  Eigen::VectorXi low, high;
};

bool is_torus(const HalfedgeMesh& mesh);
// Whether no torus has cones of so many turns of 2 pi / rotation_order.
bool is_impossible_on_torus(const Eigen::VectorXi& turns, int rotation_order);

// The quadratic form var(turns) and its exchanges.
class TurnExchange {
 public:
  TurnExchange(const HalfedgeMesh& mesh, const LogScale::Variance& variance, TurnBounds bounds, int rotation_order,
               Eigen::VectorXi turns);

  bool allowed(Index i, int step) const;

  // Single steps towards a sum of turns within the bounds, the cheapest first.
  void reach(int sum);

  // Rounding may have led to what no torus has, and exchanges do not lead there: the cheapest one leads away.
  void leave_impossible(bool keep_sum);

  // The best exchange of one turn between two cones, or where the sum is free between a cone and nothing, until none
  // lowers the variance.  `held` cones stay.
  void descend(bool keep_sum, const Array<Index>& held = {});

  // Descents stop where two exchanges at once are needed. From there each of the cheapest exchanges is made in turn
  // and held while the others follow.
  void search(bool keep_sum);

  // The variance underrates what lies far out. Exchanges that cost least by it, and pairs of them, are tried by the
  // predicted stretch.
  void refine(const LogScale& scale, bool keep_sum);

  const Eigen::VectorXi& turns() const { return turns_; }
  Eigen::VectorXd curvature() const { return turns_.cast<double>() * (2 * M_PI / rotation_order_); }

 private:
  // Of the largest terms that the variance is a sum of: well above what rounding makes of them, so that no exchange
  // and its reverse both seem to gain.
  static constexpr double relative_gain = 1e-12;
  static constexpr double operations_of_exponential = 40;
  static constexpr std::size_t least_trials = 4, most_trials = 100;
  static constexpr double trial_work = 4e6;  // entries of the Hessian times trials
  static constexpr int least_stretch_trials = 24, most_stretch_trials = 400;
  static constexpr double stretch_work = 5e5;  // vertices times trials
  static constexpr std::size_t first_exchanges = 50, continued_exchanges = 10, second_exchanges = 30;

  // A trial looks at the whole Hessian once a step.
  std::size_t trial_count() const;

  // One turn more at a cone, and one less at another where the sum is kept.
  struct Swap {
    double cost;  // what it changes the variance by
    Index first, second;
    int step;
  };

  static Swap reversed(const Swap& swap) { return {-swap.cost, swap.first, swap.second, -swap.step}; }

  // More than descents have ever needed: each cone some times there and back.
  Eigen::Index most_exchanges() const { return 100 + 20 * turns_.size(); }

  // From the turns alone, so that what is compared does not depend on the way to them.
  void evaluate();

  void apply(const Swap& swap);

  void take_turns_of(const TurnExchange& other);

  bool leads_to_impossible(const Swap& swap) const;

  // The cheapest possible ones, in order.
  Array<Swap> swaps(bool keep_sum, const Array<Index>& held, std::size_t count) const;

  bool torus_;
  TurnBounds bounds_;
  int rotation_order_;
  Eigen::VectorXi turns_;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd slope_;     // half the derivative at no turns
  Eigen::VectorXd gradient_;  // the same at the present ones
  double value_ = 0;          // what the variance exceeds that of no turns by
  double least_gain_ = 0;     // that is told from rounding
};

}  // namespace lsgp
