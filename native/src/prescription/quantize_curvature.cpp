// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/quantize_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/checkpoint.hpp"
#include "base/text.hpp"

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

// Beyond these no map exists; a corner in a single triangle has none where the turn is half a circle or more.
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

// Within the widest ones, and so those of given angles where these leave no other.
TurnBounds usual_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int symmetry, double largest_angle,
                        const TurnBounds& widest) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / symmetry, slack = 1e-9;
  TurnBounds bounds{Eigen::VectorXi(k), Eigen::VectorXi(k)};
  for (Index i = 0; i < k; ++i) {
    const double flat = mesh.flat_angle(cones.vertices[i]);
    const int triangles = valence(mesh, cones.vertices[i]);
    const double most = std::min(largest_share * triangles, largest_angle);
    const int high = static_cast<int>(std::floor((flat - smallest_angle) / unit + slack));
    const int low = std::min(0, static_cast<int>(std::ceil((flat - most) / unit - slack)));
    bounds.high[i] = std::clamp(high, widest.low[i], widest.high[i]);
    bounds.low[i] = std::clamp(low, widest.low[i], widest.high[i]);
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
    slope_ = unit * variance.gradient;
    const double steepest = slope_.cwiseAbs().maxCoeff(), most_curved = hessian_.diagonal().maxCoeff();
    least_gain_ = relative_gain * (steepest + most_curved * (1 + turns_.cwiseAbs().sum()));
    evaluate();
  }

  bool allowed(Index i, int step) const {
    return turns_[i] + step >= bounds_.low[i] && turns_[i] + step <= bounds_.high[i];
  }

  // Single steps towards a sum of turns within the bounds, the cheapest first.
  void reach(int sum) {
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

  // Rounding may have led to what no torus has, and exchanges do not lead there: the cheapest one leads away.
  void leave_impossible(bool keep_sum) {
    if (!torus_ || !is_impossible_on_torus(turns_, symmetry_)) return;
    const Array<Swap> best = swaps(keep_sum, {}, 1);
    if (!best.empty()) apply(best.front());
  }

  // The best exchange of one turn between two cones, or where the sum is free between a cone and nothing, until none
  // lowers the variance.  `held` cones stay.
  void descend(bool keep_sum, const Array<Index>& held = {}) {
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

  // Descents stop where two exchanges at once are needed. From there each of the cheapest exchanges is made in turn
  // and held while the others follow.
  void search(bool keep_sum) {
    descend(keep_sum);
    Eigen::Index left = most_exchanges();
    for (bool lowered = true; lowered && left > 0; --left) {
      lowered = false;
      for (const Swap& swap : swaps(keep_sum, {}, trial_count())) {
        Exchange trial = *this;
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

  // The variance underrates what lies far out. Exchanges that cost least by it, and pairs of them, are tried by the
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
      std::stable_sort(tried.begin(), tried.end(),
                       [](const Trial& a, const Trial& b) { return a.stretch < b.stretch; });
      return tried;
    };
    const int most = static_cast<int>(std::clamp(stretch_work / static_cast<double>(y.size()),
                                                 static_cast<double>(least_stretch_trials),
                                                 static_cast<double>(most_stretch_trials)));
    while (trials < most) {
      const double before = least;
      Array<Trial> first = try_at(*this, y, first_exchanges);
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
  std::size_t trial_count() const {
    const std::size_t affordable = static_cast<std::size_t>(trial_work / static_cast<double>(hessian_.size()));
    return std::clamp(affordable, least_trials, most_trials);
  }

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
  void evaluate() {
    const Eigen::VectorXd turns = turns_.cast<double>();
    gradient_ = slope_ + hessian_ * turns;
    value_ = turns.dot(slope_ + gradient_);
    checkpoint(static_cast<double>(hessian_.size()));
  }

  void apply(const Swap& swap) {
    turns_[swap.first] += swap.step;
    if (swap.second != none) turns_[swap.second] -= swap.step;
    evaluate();
  }

  void take_turns_of(const Exchange& other) {
    turns_ = other.turns_;
    gradient_ = other.gradient_;
    value_ = other.value_;
  }

  bool leads_to_impossible(const Swap& swap) const {
    if (!torus_) return false;
    Eigen::VectorXi moved = turns_;
    moved[swap.first] += swap.step;
    if (swap.second != none) moved[swap.second] -= swap.step;
    return is_impossible_on_torus(moved, symmetry_);
  }

  // The cheapest possible ones, in order.
  Array<Swap> swaps(bool keep_sum, const Array<Index>& held, std::size_t count) const {
    const Index k = static_cast<Index>(turns_.size());
    checkpoint(4.0 * k * k);
    Array<char> is_held(k, 0);
    for (const Index i : held) {
      if (i != none) is_held[i] = 1;
    }
    // Of those at the same cost the ones that come first.
    Array<Swap> all;
    const auto is_cheaper = [](const Swap& a, const Swap& b) { return a.cost < b.cost; };
    const auto keep_cheapest = [&] {
      std::stable_sort(all.begin(), all.end(), is_cheaper);
      if (all.size() > count) all.resize(count);
    };
    double limit = std::numeric_limits<double>::infinity();  // of the cost of what can be among them
    const auto consider = [&](const Swap& swap) {
      if (!(swap.cost < limit) || leads_to_impossible(swap)) return;
      all.push_back(swap);
      if (count > 1 && all.size() < 8 * count) return;
      keep_cheapest();
      if (all.size() == count) limit = all.back().cost;
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
    keep_cheapest();
    return all;
  }

  bool torus_;
  TurnBounds bounds_;
  int symmetry_;
  Eigen::VectorXi turns_;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd slope_;     // half the derivative at no turns
  Eigen::VectorXd gradient_;  // the same at the present ones
  double value_ = 0;          // what the variance exceeds that of no turns by
  double least_gain_ = 0;     // that is told from rounding
};

// Throws where a cone has no angle to choose from.
void require_some_angle(const ComponentCones& cones, int symmetry, const TurnBounds& widest) {
  Array<Index> without;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Eigen::Index at = static_cast<Eigen::Index>(i);
    if (widest.low[at] > widest.high[at]) without.push_back(cones.vertices[i]);
  }
  if (without.empty()) return;
  throw Error(
      Code::seamless_impossible,
      concat("The triangles around ", count(without.size(), "cone", "cones"),
             " carry less than 180 degrees each, and no multiple of ", 360 / symmetry,
             " degrees is an angle for them. Subdivide the mesh there, unmark the cones, or choose a lattice of "
             "smaller turns."),
      {ElementKind::vertices, without});
}

[[noreturn]] void throw_out_of_reach(const ComponentCones& cones, int symmetry, int sum, const TurnBounds& widest) {
  const int reached = sum > widest.high.sum() ? widest.high.sum() : widest.low.sum();
  throw Error(Code::seamless_impossible,
              concat("With angles that are multiples of ", 360 / symmetry, " degrees ",
                     count(cones.vertices.size(), "cone takes", "cones take"), " up at ",
                     reached > 0 ? "most " : "least ", reached, " of these, but the surface requires ", sum,
                     ". Mark more cones, leave given angles automatic, or choose another lattice."),
              {ElementKind::vertices, cones.vertices});
}

// What the cones' turns have to add up to by Gauss-Bonnet; none where a border's turning is free.
std::optional<int> required_turns(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale,
                                  int symmetry) {
  if (scale.balanced()) return turns_of(scale.required_sum(), symmetry);
  double sum = 2 * M_PI * mesh.euler;
  for (std::size_t loop = 0; loop < mesh.boundary_loops.size(); ++loop) {
    if (loop >= cones.loop_turning.size() || !cones.loop_turning[loop]) return std::nullopt;
    sum -= *cones.loop_turning[loop];
  }
  return turns_of(sum, symmetry);
}

}  // namespace

int turns_of(double angle, int symmetry) { return static_cast<int>(std::lround(angle * symmetry / (2 * M_PI))); }

Eigen::VectorXd quantize_curvature(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale,
                                   const Eigen::VectorXd& wanted, int symmetry) {
  const Eigen::Index k = wanted.size();
  if (k == 0) return wanted;
  TurnBounds widest = widest_bounds(mesh, cones, symmetry);
  require_some_angle(cones, symmetry, widest);
  keep_given(mesh, cones, symmetry, widest);
  const auto reaches = [](const TurnBounds& bounds, int sum) {
    return bounds.low.sum() <= sum && sum <= bounds.high.sum();
  };
  std::optional<int> required = required_turns(mesh, cones, scale, symmetry);
  if (required && !reaches(widest, *required)) {
    if (scale.balanced()) throw_out_of_reach(cones, symmetry, *required, widest);
    required.reset();  // borders give way
  }
  const bool keeps_sum = required.has_value();
  const auto reachable = [&](const TurnBounds& bounds) { return !keeps_sum || reaches(bounds, *required); };
  const LogScale::Variance variance = scale.variance();
  std::optional<Exchange> best;
  double least = std::numeric_limits<double>::infinity();
  const auto search = [&](const TurnBounds& bounds) {
    Eigen::VectorXi turns(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      turns[i] = std::clamp(turns_of(wanted[i], symmetry), bounds.low[i], bounds.high[i]);
    }
    Exchange exchange(mesh, variance, bounds, symmetry, std::move(turns));
    if (keeps_sum) exchange.reach(*required);
    exchange.leave_impossible(keeps_sum);
    exchange.search(keeps_sum);
    const double stretch = scale.lumped_l2(scale.evaluate(exchange.curvature()));
    if (best && !(stretch < least)) return;
    least = stretch;
    best = std::move(exchange);
  };
  for (const double largest_angle : largest_angles) {
    const TurnBounds bounds = usual_bounds(mesh, cones, symmetry, largest_angle, widest);
    if (reachable(bounds)) search(bounds);
  }
  if (!best) search(widest);
  best->refine(scale, keeps_sum);
  if (is_torus(mesh) && is_impossible_on_torus(best->turns(), symmetry)) {
    throw Error(Code::seamless_impossible,
                concat("No torus has just one cone of ", 360 - 360 / symmetry, " and one of ", 360 + 360 / symmetry,
                       " degrees. Mark another cone, or give both 360 degrees."),
                {ElementKind::vertices, cones.vertices});
  }
  return best->curvature();
}

}  // namespace lsgp
