// SPDX-License-Identifier: GPL-3.0-or-later
#include "quantize_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "text.hpp"

namespace lsgp {

namespace {

// Angles a map can be expected to realise: a cone from a quarter of a turn to one and a half turns, or where that
// distorts less to two, as far as its triangles can share them.
constexpr double smallest_angle = M_PI / 2;
constexpr double largest_angles[] = {3 * M_PI, 4 * M_PI};
constexpr double largest_share = 100 * M_PI / 180;  // of a triangle in the angle of its cone
constexpr double exact_multiple = 1e-6;             // radians, between a given angle and the multiple it is taken for

// Bounds of the turns a cone may take away.
struct TurnBounds {
  Eigen::VectorXi low, high;
};

TurnBounds usual_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int symmetry, double largest_angle) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / symmetry, slack = 1e-9;
  TurnBounds bounds{Eigen::VectorXi(k), Eigen::VectorXi(k)};
  for (Index i = 0; i < k; ++i) {
    const double flat = mesh.flat_angle(cones.vertices[i]);
    const int triangles = valence(mesh, cones.vertices[i]);
    const double most = std::min(largest_share * triangles, largest_angle);
    bounds.high[i] = static_cast<int>(std::floor((flat - smallest_angle) / unit + slack));
    bounds.low[i] = std::min(0, static_cast<int>(std::ceil((flat - most) / unit - slack)));
  }
  return bounds;
}

// Beyond these no map exists.
TurnBounds widest_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int symmetry) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / symmetry, slack = 1e-9;
  TurnBounds bounds{Eigen::VectorXi(k), Eigen::VectorXi(k)};
  for (Index i = 0; i < k; ++i) {
    const double flat = mesh.flat_angle(cones.vertices[i]);
    bounds.high[i] = static_cast<int>(std::ceil(flat / unit - slack)) - 1;
    bounds.low[i] = static_cast<int>(std::floor((flat - M_PI * valence(mesh, cones.vertices[i])) / unit + slack)) + 1;
  }
  return bounds;
}

// Given angles that are multiples of the turn are kept.
void keep_given(const HalfedgeMesh& mesh, const ComponentCones& cones, int symmetry, TurnBounds& bounds) {
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    if (!cones.angles[i]) continue;
    const double curvature = mesh.flat_angle(cones.vertices[i]) - *cones.angles[i];
    const int turns = turns_of(curvature, symmetry);
    if (std::abs(curvature - angle_of_turns(turns, symmetry)) > exact_multiple) continue;
    bounds.low[static_cast<Eigen::Index>(i)] = bounds.high[static_cast<Eigen::Index>(i)] = turns;
  }
}

// A torus whose only cones are one of +1 and one of -1 turns does not exist (Izmestiev, Kusner, Rote, Springborn,
// Sullivan: There is no triangulation of the torus with vertex degrees 5, 6, ..., 6, 7, 2013, theorem 5).
bool is_torus(const HalfedgeMesh& mesh) { return mesh.closed() && mesh.genus == 1; }
bool is_impossible_on_torus(const Eigen::VectorXi& turns, int symmetry) {
  if (symmetry == 1) return false;
  int cones = 0;
  bool coprime = true;
  for (const int t : turns) {
    if (t == 0) continue;
    ++cones;
    coprime = coprime && std::gcd(std::abs(t), symmetry) == 1;
  }
  return cones == 2 && coprime;
}

// The quadratic form var(turns) and its exchanges.
class Exchange {
 public:
  Exchange(const HalfedgeMesh& mesh, const LogScale::Variance& variance, TurnBounds bounds, int symmetry,
           Eigen::VectorXi turns)
      : torus_(is_torus(mesh)), bounds_(std::move(bounds)), symmetry_(symmetry), turns_(std::move(turns)) {
    const double unit = 2 * M_PI / symmetry;
    hessian_ = unit * unit * variance.hessian;
    gradient_ = unit * variance.gradient + hessian_ * turns_.cast<double>();
  }

  bool allowed(Index i, int step) const {
    return turns_[i] + step >= bounds_.low[i] && turns_[i] + step <= bounds_.high[i];
  }

  // Single steps towards a sum of turns within the bounds, the cheapest first.
  void reach(int sum) {
    for (int missing = sum - turns_.sum(); missing != 0; missing = sum - turns_.sum()) {
      const int step = missing > 0 ? 1 : -1;
      Index best = none;
      double least = std::numeric_limits<double>::infinity();
      for (Index i = 0; i < turns_.size(); ++i) {
        const double cost = 2 * gradient_[i] * step + hessian_(i, i);
        if (allowed(i, step) && cost < least) {
          least = cost;
          best = i;
        }
      }
      add(best, step);
    }
  }

  // Rounding may have led to what no torus has, and exchanges do not lead there: the cheapest one leads away.
  void leave_impossible(bool keep_sum) {
    if (!torus_ || !is_impossible_on_torus(turns_, symmetry_)) return;
    const std::vector<Swap> best = swaps(keep_sum, {}, 1);
    if (!best.empty()) apply(best.front());
  }

  // The best exchange of one turn between two cones, or where the sum is free between a cone and nothing, until none
  // lowers the variance.  Returns by how much it was lowered; `held` cones stay.
  double descend(bool keep_sum, const std::vector<Index>& held = {}) {
    double lowered = 0;
    while (true) {
      const std::vector<Swap> best = swaps(keep_sum, held, 1);
      if (best.empty() || best.front().cost >= -least_gain) return lowered;
      apply(best.front());
      lowered -= best.front().cost;
    }
  }

  // Descents stop where two exchanges at once are needed.  From there each of the cheapest exchanges is made in turn
  // and held while the others follow.
  void search(bool keep_sum) {
    descend(keep_sum);
    for (bool lowered = true; lowered;) {
      lowered = false;
      for (const Swap& swap : swaps(keep_sum, {}, most_trials)) {
        Exchange trial = *this;
        trial.apply(swap);
        double gain = -swap.cost + trial.descend(keep_sum, {swap.first, swap.second});
        gain += trial.descend(keep_sum);
        if (gain <= least_gain) continue;
        turns_ = trial.turns_;
        gradient_ = trial.gradient_;
        lowered = true;
        break;
      }
    }
  }

  // The variance underrates what lies far out.  Exchanges that cost least by it, and pairs of them, are tried by the
  // predicted stretch.
  void refine(const LogScale& scale, bool keep_sum) {
    const double unit = 2 * M_PI / symmetry_;
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
    const auto try_at = [&](Exchange turns, const Eigen::VectorXd& at, std::size_t count) {
      std::vector<Trial> tried;
      for (const Swap& swap : turns.swaps(keep_sum, {}, count)) {
        Eigen::VectorXd there = moved(at, swap);
        tried.push_back({scale.lumped_l2(there), swap});
        ++trials;
        if (!(tried.back().stretch < least * (1 - 1e-9))) continue;
        least = tried.back().stretch;
        y = std::move(there);
        turns.apply(swap);
        turns_ = turns.turns_;
        gradient_ = turns.gradient_;
        return std::vector<Trial>();
      }
      std::stable_sort(tried.begin(), tried.end(),
                       [](const Trial& a, const Trial& b) { return a.stretch < b.stretch; });
      return tried;
    };
    const int most = static_cast<int>(std::clamp(stretch_work / static_cast<double>(y.size()),
                                                 static_cast<double>(least_stretch_trials),
                                                 static_cast<double>(most_stretch_trials)));
    while (trials < most) {
      const double before = least;
      std::vector<Trial> first = try_at(*this, y, first_exchanges);
      if (first.size() > continued_exchanges) first.resize(continued_exchanges);
      for (const Trial& trial : first) {
        Exchange turns = *this;
        turns.apply(trial.swap);
        try_at(turns, moved(y, trial.swap), second_exchanges);
        if (least < before || trials >= most) break;
      }
      if (!(least < before)) break;
    }
  }

  const Eigen::VectorXi& turns() const { return turns_; }
  Eigen::VectorXd curvature() const { return turns_.cast<double>() * (2 * M_PI / symmetry_); }

 private:
  static constexpr double least_gain = 1e-12;
  static constexpr std::size_t most_trials = 100;
  static constexpr int least_stretch_trials = 24, most_stretch_trials = 400;
  static constexpr double stretch_work = 5e5;  // vertices times trials
  static constexpr std::size_t first_exchanges = 50, continued_exchanges = 10, second_exchanges = 30;

  // One turn more at a cone, and one less at another where the sum is kept.
  struct Swap {
    double cost;  // what it changes the variance by
    Index first, second;
    int step;
  };

  void add(Index i, int step) {
    turns_[i] += step;
    gradient_ += step * hessian_.col(i);
  }

  void apply(const Swap& swap) {
    add(swap.first, swap.step);
    if (swap.second != none) add(swap.second, -swap.step);
  }

  bool leads_to_impossible(const Swap& swap) const {
    if (!torus_) return false;
    Eigen::VectorXi moved = turns_;
    moved[swap.first] += swap.step;
    if (swap.second != none) moved[swap.second] -= swap.step;
    return is_impossible_on_torus(moved, symmetry_);
  }

  // The cheapest possible ones, in order.
  std::vector<Swap> swaps(bool keep_sum, const std::vector<Index>& held, std::size_t count) const {
    const Index k = static_cast<Index>(turns_.size());
    std::vector<char> is_held(k, 0);
    for (const Index i : held) {
      if (i != none) is_held[i] = 1;
    }
    std::vector<Swap> all;
    const auto consider = [&](const Swap& swap) {
      const bool improves = count > 1 || all.empty() || swap.cost < all.front().cost;
      if (!improves || leads_to_impossible(swap)) return;
      if (count == 1) all.clear();
      all.push_back(swap);
    };
    for (Index i = 0; i < k; ++i) {
      if (is_held[i]) continue;
      for (const int step : {1, -1}) {
        if (!allowed(i, step)) continue;
        const double alone = 2 * gradient_[i] * step + hessian_(i, i);
        if (!keep_sum) consider({alone, i, none, step});
        for (Index j = 0; j < k; ++j) {
          if (j == i || is_held[j] || !allowed(j, -step)) continue;
          consider({alone - 2 * gradient_[j] * step + hessian_(j, j) - 2 * hessian_(i, j), i, j, step});
        }
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Swap& a, const Swap& b) { return a.cost < b.cost; });
    if (all.size() > count) all.resize(count);
    return all;
  }

  bool torus_;
  TurnBounds bounds_;
  int symmetry_;
  Eigen::VectorXi turns_;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;  // half the derivative at the present turns
};

[[noreturn]] void throw_out_of_reach(const ComponentCones& cones, int symmetry, int sum, const TurnBounds& widest) {
  const int reached = sum > widest.high.sum() ? widest.high.sum() : widest.low.sum();
  throw Error(Code::seamless_impossible,
              concat("With angles that are multiples of ", 360 / symmetry, " degrees ",
                     count(cones.vertices.size(), "cone takes", "cones take"), " up at ",
                     reached > 0 ? "most " : "least ", reached, " of these, but the surface requires ", sum,
                     ". Mark more cones, leave given angles automatic, or choose another lattice."),
              {ElementKind::vertices, cones.vertices});
}

}  // namespace

int turns_of(double angle, int symmetry) { return static_cast<int>(std::lround(angle * symmetry / (2 * M_PI))); }

Eigen::VectorXd quantize_curvature(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale,
                                   const Eigen::VectorXd& wanted, int symmetry) {
  const Eigen::Index k = wanted.size();
  if (k == 0) return wanted;
  const bool balanced = scale.balanced();
  const int sum = balanced ? turns_of(scale.required_sum(), symmetry) : 0;
  TurnBounds widest = widest_bounds(mesh, cones, symmetry);
  keep_given(mesh, cones, symmetry, widest);
  const auto reachable = [&](const TurnBounds& bounds) {
    return !balanced || (bounds.low.sum() <= sum && sum <= bounds.high.sum());
  };
  if (!reachable(widest)) throw_out_of_reach(cones, symmetry, sum, widest);
  const LogScale::Variance variance = scale.variance();
  std::optional<Exchange> best;
  double least = std::numeric_limits<double>::infinity();
  const auto search = [&](const TurnBounds& bounds) {
    Eigen::VectorXi turns(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      turns[i] = std::clamp(turns_of(wanted[i], symmetry), bounds.low[i], bounds.high[i]);
    }
    Exchange exchange(mesh, variance, bounds, symmetry, std::move(turns));
    if (balanced) exchange.reach(sum);
    exchange.leave_impossible(balanced);
    exchange.search(balanced);
    const double stretch = scale.lumped_l2(scale.evaluate(exchange.curvature()));
    if (best && !(stretch < least)) return;
    least = stretch;
    best = std::move(exchange);
  };
  for (const double largest_angle : largest_angles) {
    TurnBounds bounds = usual_bounds(mesh, cones, symmetry, largest_angle);
    keep_given(mesh, cones, symmetry, bounds);
    if (reachable(bounds)) search(bounds);
  }
  if (!best) search(widest);
  best->refine(scale, balanced);
  if (is_torus(mesh) && is_impossible_on_torus(best->turns(), symmetry)) {
    throw Error(Code::seamless_impossible,
                concat("No torus has just one cone of ", 360 - 360 / symmetry, " and one of ", 360 + 360 / symmetry,
                       " degrees. Mark another cone, or give both 360 degrees."),
                {ElementKind::vertices, cones.vertices});
  }
  return best->curvature();
}

}  // namespace lsgp
