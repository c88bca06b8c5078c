// SPDX-License-Identifier: GPL-3.0-or-later
#include "quantize_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "text.hpp"

namespace lsgp {

namespace {

// Angles a map can be expected to realise on the lattice's own mesh: a cone from a quarter of a turn to one and a half
// turns, more only where many triangles share it.
constexpr double smallest_angle = M_PI / 2;
constexpr double largest_angle = 3 * M_PI;
constexpr double usual_share = 100 * M_PI / 180;   // of a triangle in the angle of its cone
constexpr double crowded_share = 80 * M_PI / 180;  // the same beyond the largest angle
constexpr double exact_multiple = 1e-6;            // radians, between a given angle and the multiple it is taken for

// Bounds of the turns a cone may take away.
struct TurnBounds {
  Eigen::VectorXi low, high;
};

TurnBounds usual_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int symmetry) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / symmetry, slack = 1e-9;
  TurnBounds bounds{Eigen::VectorXi(k), Eigen::VectorXi(k)};
  for (Index i = 0; i < k; ++i) {
    const double flat = mesh.flat_angle(cones.vertices[i]);
    const int triangles = valence(mesh, cones.vertices[i]);
    const double most = std::min(usual_share * triangles, std::max(largest_angle, crowded_share * triangles));
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
bool is_impossible_torus(const HalfedgeMesh& mesh, const Eigen::VectorXi& turns, int symmetry) {
  if (!mesh.closed() || mesh.genus != 1 || symmetry == 1) return false;
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
  Exchange(const HalfedgeMesh& mesh, const LogScale& scale, const TurnBounds& bounds, int symmetry,
           Eigen::VectorXi turns)
      : mesh_(mesh), bounds_(bounds), symmetry_(symmetry), turns_(std::move(turns)) {
    const LogScale::Variance variance = scale.variance();
    const double unit = 2 * M_PI / symmetry;
    hessian_ = unit * unit * variance.hessian;
    gradient_ = unit * variance.gradient + hessian_ * turns_.cast<double>();
  }

  // What adding `first` to cone i and `second` to cone j changes the variance by.
  double change(Index i, int first, Index j, int second) const {
    return 2 * (gradient_[i] * first + gradient_[j] * second) + hessian_(i, i) * first * first +
           hessian_(j, j) * second * second + 2 * hessian_(i, j) * first * second;
  }

  bool allowed(Index i, int step) const {
    return turns_[i] + step >= bounds_.low[i] && turns_[i] + step <= bounds_.high[i];
  }

  bool possible_after(Index i, int first, Index j, int second) const {
    Eigen::VectorXi moved = turns_;
    moved[i] += first;
    moved[j] += second;
    return !is_impossible_torus(mesh_, moved, symmetry_);
  }

  void add(Index i, int step) {
    turns_[i] += step;
    gradient_ += step * hessian_.col(i);
  }

  // Single steps towards a sum of turns, the cheapest first.  Returns whether it was reached.
  bool reach(int sum) {
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
      if (best == none) return false;
      add(best, step);
    }
    return true;
  }

  // The best exchange of one turn between two cones, or where the sum is free between a cone and nothing, until none
  // lowers the variance.
  void descend(bool keep_sum) {
    constexpr double least_gain = 1e-12;
    while (true) {
      Index first = none, second = none;
      int first_step = 0, second_step = 0;
      double least = -least_gain;
      const auto consider = [&](Index i, int step_i, Index j, int step_j) {
        const double cost = change(i, step_i, j, step_j);
        if (cost >= least || !possible_after(i, step_i, j, step_j)) return;
        least = cost;
        std::tie(first, first_step, second, second_step) = std::tuple{i, step_i, j, step_j};
      };
      for (Index i = 0; i < turns_.size(); ++i) {
        for (const int step : {1, -1}) {
          if (!allowed(i, step)) continue;
          if (!keep_sum) consider(i, step, i == 0 ? Index(turns_.size()) - 1 : 0, 0);
          for (Index j = 0; j < turns_.size(); ++j) {
            if (j != i && allowed(j, -step)) consider(i, step, j, -step);
          }
        }
      }
      if (first == none) return;
      add(first, first_step);
      if (second_step != 0) add(second, second_step);
    }
  }

  const Eigen::VectorXi& turns() const { return turns_; }

 private:
  const HalfedgeMesh& mesh_;
  const TurnBounds& bounds_;
  const int symmetry_;
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
  TurnBounds bounds = usual_bounds(mesh, cones, symmetry), widest = widest_bounds(mesh, cones, symmetry);
  keep_given(mesh, cones, symmetry, bounds);
  keep_given(mesh, cones, symmetry, widest);
  if (balanced && (sum < widest.low.sum() || sum > widest.high.sum())) {
    throw_out_of_reach(cones, symmetry, sum, widest);
  }
  if (balanced && (sum < bounds.low.sum() || sum > bounds.high.sum())) bounds = widest;
  Eigen::VectorXi turns(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    turns[i] = std::clamp(turns_of(wanted[i], symmetry), bounds.low[i], bounds.high[i]);
  }
  Exchange exchange(mesh, scale, bounds, symmetry, std::move(turns));
  if (balanced) exchange.reach(sum);
  exchange.descend(balanced);
  if (is_impossible_torus(mesh, exchange.turns(), symmetry)) {
    throw Error(Code::seamless_impossible,
                concat("No torus has just one cone of ", 360 - 360 / symmetry, " and one of ", 360 + 360 / symmetry,
                       " degrees. Mark another cone, or give both 360 degrees."),
                {ElementKind::vertices, cones.vertices});
  }
  return exchange.turns().cast<double>() * (2 * M_PI / symmetry);
}

}  // namespace lsgp
