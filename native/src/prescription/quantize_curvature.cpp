// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/quantize_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "prescription/turn_exchange.hpp"

namespace lsgp {

namespace {

// Angles that maps can be expected to realize: from a quarter turn to one and a half turns, or to two if that distorts
// less, as far as the triangles around the cone can share them.
constexpr double smallest_angle = M_PI / 2;
constexpr double largest_angles[] = {3 * M_PI, 4 * M_PI};
constexpr double largest_share = 100 * M_PI / 180;  // of a triangle in the angle of its cone
constexpr double exact_multiple = 1e-6;             // radians, between a given angle and the multiple it is taken for

// Beyond these no map exists; a corner in a single triangle has none if the rotation is a half turn or more.
TurnBounds widest_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int rotation_order) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / rotation_order, slack = 1e-9;
  TurnBounds bounds{Eigen::VectorXi(k), Eigen::VectorXi(k)};
  for (Index i = 0; i < k; ++i) {
    const double flat = mesh.flat_angle(cones.vertices[i]);
    bounds.high[i] = static_cast<int>(std::ceil(flat / unit - slack)) - 1;
    bounds.low[i] = static_cast<int>(std::floor((flat - M_PI * valence(mesh, cones.vertices[i])) / unit + slack)) + 1;
  }
  return bounds;
}

// Within the widest bounds, which are those of given angles if nothing else remains.
TurnBounds usual_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones, int rotation_order, double largest_angle,
                        const TurnBounds& widest) {
  const Index k = static_cast<Index>(cones.vertices.size());
  const double unit = 2 * M_PI / rotation_order, slack = 1e-9;
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

// Given angles that are multiples of the lattice's rotation are kept.
void keep_given(const HalfedgeMesh& mesh, const ComponentCones& cones, int rotation_order, TurnBounds& bounds) {
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    if (!cones.angles[i]) continue;
    const double curvature = mesh.flat_angle(cones.vertices[i]) - *cones.angles[i];
    const int turns = turns_of(curvature, rotation_order);
    if (std::abs(curvature - angle_of_turns(turns, rotation_order)) > exact_multiple) continue;
    bounds.low[static_cast<Eigen::Index>(i)] = bounds.high[static_cast<Eigen::Index>(i)] = turns;
  }
}

// Throws if a cone has no admissible angle.
void require_some_angle(const ComponentCones& cones, int rotation_order, const TurnBounds& widest) {
  Array<Index> without;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Eigen::Index at = static_cast<Eigen::Index>(i);
    if (widest.low[at] > widest.high[at]) without.push_back(cones.vertices[i]);
  }
  if (without.empty()) return;
  throw Error(
      Code::seamless_impossible,
      concat("The triangles around ", count(without.size(), "cone", "cones"),
             " carry less than 180 degrees each, and no multiple of ", 360 / rotation_order,
             " degrees is an angle for them. Subdivide the mesh there, unmark the cones, or choose a lattice of "
             "smaller turns."),
      {ElementKind::vertices, without});
}

[[noreturn]] void throw_out_of_reach(const ComponentCones& cones, int rotation_order, int sum,
                                     const TurnBounds& widest) {
  const bool needs_more = sum > widest.high.sum();
  // Where only whole turns are angles, cones take up no curvature, however many there are.
  const bool has_other_angles = rotation_order > 1;
  throw Error(
      Code::seamless_impossible,
      concat("With angles that are multiples of ", 360 / rotation_order, " degrees ",
             count(cones.vertices.size(), "cone takes", "cones take"), " up at ", needs_more ? "most " : "least ",
             needs_more ? widest.high.sum() : widest.low.sum(), " of these, but the surface requires ", sum, ". ",
             needs_more && !has_other_angles ? "Choose another lattice."
                                             : "Mark more cones, leave given angles automatic, or choose "
                                               "another lattice."),
      {ElementKind::vertices, cones.vertices});
}

// The sum of the cones' turns that Gauss-Bonnet requires; none if the turning of a boundary is free.
std::optional<int> required_turns(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale,
                                  int rotation_order) {
  if (scale.balanced()) return turns_of(scale.required_sum(), rotation_order);
  double sum = 2 * M_PI * mesh.euler;
  for (std::size_t loop = 0; loop < mesh.boundary_loops.size(); ++loop) {
    if (loop >= cones.loop_turning.size() || !cones.loop_turning[loop]) return std::nullopt;
    sum -= *cones.loop_turning[loop];
  }
  return turns_of(sum, rotation_order);
}

}  // namespace

int turns_of(double angle, int rotation_order) {
  return static_cast<int>(std::lround(angle * rotation_order / (2 * M_PI)));
}

Eigen::VectorXd quantize_curvature(const ComponentCones& cones, const LogScale& scale, const Eigen::VectorXd& wanted,
                                   int rotation_order, const std::optional<PricedForm>& priced) {
  const HalfedgeMesh& mesh = scale.mesh();
  const Eigen::Index k = wanted.size();
  if (k == 0) return wanted;
  TurnBounds widest = widest_bounds(mesh, cones, rotation_order);
  require_some_angle(cones, rotation_order, widest);
  keep_given(mesh, cones, rotation_order, widest);
  const auto reaches = [](const TurnBounds& bounds, int sum) {
    return bounds.low.sum() <= sum && sum <= bounds.high.sum();
  };
  std::optional<int> required = required_turns(mesh, cones, scale, rotation_order);
  if (required && !reaches(widest, *required)) {
    if (scale.balanced()) throw_out_of_reach(cones, rotation_order, *required, widest);
    required.reset();  // boundaries are free
  }
  const bool keeps_sum = required.has_value();
  const auto reachable = [&](const TurnBounds& bounds) { return !keeps_sum || reaches(bounds, *required); };
  LogScale::Variance cost = scale.variance();
  if (priced) {  // the logarithm of the L2 stretch is about twice the variance
    cost.hessian += priced->price / 2 * priced->form.hessian;
    cost.gradient += priced->price / 2 * priced->form.gradient;
  }
  std::optional<TurnExchange> best;
  double least = std::numeric_limits<double>::infinity();
  const auto search = [&](const TurnBounds& bounds) {
    Eigen::VectorXi turns(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      turns[i] = std::clamp(turns_of(wanted[i], rotation_order), bounds.low[i], bounds.high[i]);
    }
    TurnExchange exchange(mesh, cost, bounds, rotation_order, std::move(turns));
    if (keeps_sum) exchange.reach(*required);
    exchange.leave_impossible(keeps_sum);
    exchange.search(keeps_sum);
    const Eigen::VectorXd curvature = exchange.curvature();
    double stretch = scale.lumped_l2(scale.evaluate(curvature));
    if (priced) stretch *= std::exp(priced->at(curvature));
    if (best && !(stretch < least)) return;
    least = stretch;
    best = std::move(exchange);
  };
  for (const double largest_angle : largest_angles) {
    const TurnBounds bounds = usual_bounds(mesh, cones, rotation_order, largest_angle, widest);
    if (reachable(bounds)) search(bounds);
  }
  if (!best) search(widest);
  if (!priced) best->refine(scale, keeps_sum);  // which knows stretch alone
  if (is_torus(mesh) && is_impossible_on_torus(best->turns(), rotation_order)) {
    throw Error(Code::seamless_impossible,
                concat("No torus has just one cone of ", 360 - 360 / rotation_order, " and one of ",
                       360 + 360 / rotation_order, " degrees. Mark another cone, or give both 360 degrees."),
                {ElementKind::vertices, cones.vertices});
  }
  return best->curvature();
}

}  // namespace lsgp
