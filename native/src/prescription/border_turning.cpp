// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/border_turning.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/text.hpp"
#include "prescription/component_system.hpp"
#include "prescription/hole_translation.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

using Turning = PerLoop<std::optional<double>>;  // radians, where it is not left free

constexpr double mismatch = 1e-6;  // of Gauss-Bonnet, radians

// Log scales c along the boundaries (loops) that give the wanted turning to some of them, and are 0 on the others: the
// turning is affine in c.
class LoopScales {
 public:
  explicit LoopScales(const LogScale& scale) : mesh_(scale.mesh()), geometry_(scale.geometry()), scale_(scale) {}

  const LogScale& scale() const { return scale_; }

  Eigen::VectorXd turning(const Eigen::VectorXd& log_scale) const {
    return turning_of(geometry_.angle_defect + apply_laplacian({mesh_, geometry_}, log_scale));
  }

  // The log scale changed so that loop i turns by wanted[i] where given, and the shifts that took, (loops).
  std::pair<Eigen::VectorXd, Eigen::VectorXd> adjust(const Eigen::VectorXd& log_scale, const Turning& wanted) const {
    Array<Index> loops;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i]) loops.push_back(static_cast<Index>(i));
    }
    const Eigen::VectorXd before = turning(log_scale);
    if (loops.size() == wanted.size()) {
      // Shifting all boundaries alike has no effect: the last turning follows from the others.
      double sum = 0;
      for (const auto& turning : wanted) sum += *turning;
      if (!(std::abs(sum - before.sum()) <= mismatch)) {
        throw Error(Code::loop_turning, concat("The turning prescribed for all boundaries adds up to ", degrees(sum),
                                               ", but with these cone angles it has to be ", degrees(before.sum()),
                                               ". Leave the turning of one boundary free."));
      }
      loops.pop_back();
    }
    const Index k = static_cast<Index>(loops.size());
    Eigen::VectorXd shifts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wanted.size()));
    if (k == 0) return {log_scale, shifts};
    Eigen::VectorXd missing(k);
    for (Index j = 0; j < k; ++j) missing[j] = *wanted[loops[j]] - before[loops[j]];
    const Eigen::VectorXd shift = k <= most_dense ? solve_dense(loops, missing) : solve_iteratively(loops, missing);
    for (Index j = 0; j < k; ++j) shifts[loops[j]] = shift[j];
    return {log_scale + caused_by(loops, shift), shifts};
  }

 private:
  static constexpr Index most_dense = 64;       // loops, beyond which a matrix for them takes more than iterations
  static constexpr int most_iterations = 1000;  // a back-substitution each, about 4 times the root of the loops' number
  static constexpr double accuracy = 1e-14;     // of the missing turning

  // The log scale, (n), that is constant on some boundaries, 0 on the others, and harmonic between them.
  Eigen::VectorXd caused_by(const Array<Index>& loops, const Eigen::VectorXd& shift) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh_.vertex_count());
    for (std::size_t j = 0; j < loops.size(); ++j) {
      for (const Index v : mesh_.boundary_loops[loops[j]]) out[v] = shift[static_cast<Eigen::Index>(j)];
    }
    return extend_from_borders({mesh_, geometry_}, scale_, out);
  }

  Eigen::VectorXd change_of_turning(const Array<Index>& loops, const Eigen::VectorXd& shift) const {
    return turning_of(apply_laplacian({mesh_, geometry_}, caused_by(loops, shift)))(loops);
  }

  Eigen::VectorXd solve_dense(const Array<Index>& loops, const Eigen::VectorXd& missing) const {
    const Index k = static_cast<Index>(loops.size());
    Eigen::MatrixXd effect(k, k);
    for (Index j = 0; j < k; ++j) effect.col(j) = change_of_turning(loops, Eigen::VectorXd::Unit(k, j));
    return effect.partialPivLu().solve(missing);
  }

  // The change of turning is a Schur complement of the Laplacian and so symmetric and positive definite: conjugate
  // gradients, restarted once to recover rounding errors.
  Eigen::VectorXd solve_iteratively(const Array<Index>& loops, const Eigen::VectorXd& missing) const {
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(missing.size());
    const double enough = accuracy * missing.norm();
    for (int start = 0; start < 2; ++start) {
      Eigen::VectorXd residual = missing - change_of_turning(loops, shift), direction = residual;
      double square = residual.squaredNorm();
      for (int i = 0; i < most_iterations && std::sqrt(square) > enough; ++i) {
        const Eigen::VectorXd change = change_of_turning(loops, direction);
        const double length = square / direction.dot(change);
        if (!std::isfinite(length)) break;
        shift += length * direction;
        residual -= length * change;
        const double before = std::exchange(square, residual.squaredNorm());
        direction = residual + (square / before) * direction;
      }
    }
    return shift;
  }

  Eigen::VectorXd turning_of(const Eigen::VectorXd& curvature) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(ssize(mesh_.boundary_loops));
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      for (const Index v : mesh_.boundary_loops[i]) out[i] += curvature[v];
    }
    return out;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const LogScale& scale_;
};

// Boundaries whose scale can be shifted: those with a vertex that is not a corner.
PerLoop<char> shiftable_loops(const HalfedgeMesh& mesh, const BorderConditions& border) {
  PerLoop<char> out;
  for (const auto& loop : mesh.boundary_loops) {
    out.push_back(std::any_of(loop.begin(), loop.end(), [&](Index v) { return border.held[v]; }));
  }
  return out;
}

// The turning of all boundaries rounded to multiples of 2 pi / rotation_order with the same sum: boundaries without
// prescribed turning, or all if it is prescribed for all, compensate, those with the largest rounding error first.
void quantize_turning(const Eigen::VectorXd& turning, int rotation_order, Turning& wanted) {
  const double unit = 2 * M_PI / rotation_order;
  Eigen::VectorXd exact = turning / unit;
  Array<Eigen::Index> adjustable;
  for (Eigen::Index i = 0; i < turning.size(); ++i) {
    if (wanted[i])
      exact[i] = *wanted[i] / unit;
    else
      adjustable.push_back(i);
  }
  if (adjustable.empty()) {
    adjustable.resize(turning.size());
    std::iota(adjustable.begin(), adjustable.end(), 0);
  }
  Eigen::VectorXd rounded = exact.array().round();
  double missing = std::round(turning.sum() / unit) - rounded.sum();
  // Rounding leaves less than a step for every boundary; prescribed turning may leave more, which is shared evenly.
  const double count = static_cast<double>(adjustable.size()), whole = std::trunc(missing / count);
  for (const Eigen::Index i : adjustable) rounded[i] += whole;
  missing -= whole * count;
  const double step = missing > 0 ? 1 : -1;
  for (double taken = 0; taken < std::abs(missing); ++taken) {
    const auto lost = [&](Eigen::Index i) { return step * (exact[i] - rounded[i]); };
    rounded[*std::max_element(adjustable.begin(), adjustable.end(),
                              [&](Eigen::Index a, Eigen::Index b) { return lost(a) < lost(b); })] += step;
  }
  for (Eigen::Index i = 0; i < turning.size(); ++i) wanted[i] = rounded[i] * unit;
}

// Holes about which the metric turns almost exactly once are made to turn exactly once if that takes no more than this
// shift of the log scale along their boundary: the layout closes around them without a cut.
constexpr double largest_hole_shift = 0.1;
constexpr double nearly_once = 0.5;  // radians off a full turn

// Returns the boundaries' turning, wanted or of holes that also close, and changes the log scale accordingly.
Turning close_near_holes(const LoopScales& loops, const PerLoop<char>& shiftable, const Turning& wanted,
                         Eigen::VectorXd& log_scale) {
  const Eigen::VectorXd turning = loops.turning(log_scale);
  Turning closed = wanted;
  std::size_t left_free = 0;
  for (Eigen::Index i = 0; i < turning.size(); ++i) {
    const bool hole = shiftable[i] && !wanted[i] && std::abs(turning[i] - once_around_a_hole) < nearly_once;
    if (hole) closed[i] = once_around_a_hole;
    left_free += !closed[i] && shiftable[i];
  }
  if (left_free == 0) return wanted;  // one boundary has to take up the rest
  // Drops holes that require too much until the remaining ones can be closed.
  while (true) {
    auto [adjusted, shifts] = loops.adjust(log_scale, closed);
    bool dropped = false;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (wanted[i] || !closed[i] || std::abs(shifts[static_cast<Eigen::Index>(i)]) <= largest_hole_shift) continue;
      closed[i].reset();
      dropped = true;
    }
    if (dropped) continue;
    log_scale = std::move(adjusted);
    return closed;
  }
}

// A component without handles and interior cones can be laid out in the plane as it is: the boundary with the largest
// natural turning encloses all others, which are holes.
bool is_planar(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  return mesh.genus == 0 && inside_only(mesh, cones.vertices).empty();
}

// The log scale with which all holes of a planar component close, or none if there is none.
std::optional<Eigen::VectorXd> close_all_holes(const LoopScales& loops, const PerLoop<char>& shiftable, Holes holes,
                                               const Eigen::VectorXd& log_scale) {
  constexpr double worth = 1.5;      // times that with holes whose boundaries have a gap
  constexpr Index most_closed = 20;  // holes; beyond, three back-substitutions each are too many
  const LogScale& scale = loops.scale();
  Eigen::Index outer = 0;
  loops.turning(log_scale).maxCoeff(&outer);
  Turning wanted(shiftable.size(), once_around_a_hole);
  wanted[outer].reset();
  Array<Index> inner;
  for (std::size_t i = 0; i < shiftable.size(); ++i) {
    if (!wanted[i]) continue;
    if (!shiftable[i]) return std::nullopt;
    inner.push_back(static_cast<Index>(i));
  }
  auto [closed, shifts] = loops.adjust(log_scale, wanted);
  const auto is_taken = [&](const Eigen::VectorXd& tried) {
    return holes == Holes::all ? tried.maxCoeff() - tried.minCoeff() < wide_range
                               : scale.predicted_l2(tried) <= cheap_holes * scale.predicted_l2(log_scale);
  };
  if (!is_taken(closed)) return std::nullopt;
  // The map absorbs the small gap where the metric turns nearly once.
  if (shifts.cwiseAbs().maxCoeff() > largest_hole_shift && ssize(inner) <= most_closed) {
    const auto exact = close_translations(scale.surface(), scale, inner, closed);
    const bool pays = exact && is_taken(*exact) && scale.predicted_l2(*exact) <= worth * scale.predicted_l2(closed);
    if (pays) return exact;
  }
  return std::move(closed);
}

}  // namespace

void prescribe_turning(const LogScale& scale, const ComponentCones& cones, Curvature& curvature) {
  const HalfedgeMesh& mesh = scale.mesh();
  const BorderConditions& border = scale.border();
  const std::size_t loop_count = mesh.boundary_loops.size();
  curvature.needs_no_cut.assign(loop_count, 0);
  const PerLoop<char> shiftable = shiftable_loops(mesh, border);
  for (std::size_t i = 0; i < cones.loop_turning.size(); ++i) {
    if (!cones.loop_turning[i] || shiftable[i]) continue;
    throw Error(
        Code::loop_turning,
        "The turning of a boundary cannot be prescribed if the boundary is straight or all its vertices are corners: "
        "their angles determine it. Leave its turning free.",
        {ElementKind::vertices, mesh.boundary_loops[i]});
  }
  if (border.balanced) return;
  const LoopScales loops(scale);
  Turning wanted = cones.loop_turning;
  wanted.resize(loop_count);
  const bool is_free = std::none_of(wanted.begin(), wanted.end(), [](const auto& turning) { return turning; });
  const bool rounds = cones.rotation_order > 0;
  const bool may_close_all = cones.holes == Holes::all || (cones.holes == Holes::where_cheap && !rounds);
  if (loop_count > 1 && is_free && is_planar(mesh, cones) && may_close_all) {
    if (auto closed = close_all_holes(loops, shiftable, cones.holes, curvature.log_scale)) {
      curvature.log_scale = std::move(*closed);
      curvature.needs_no_cut.assign(loop_count, 1);
      return;
    }
  }
  if (rounds) quantize_turning(loops.turning(curvature.log_scale), cones.rotation_order, wanted);
  curvature.log_scale = loops.adjust(curvature.log_scale, wanted).first;
  const Turning reached =
      cones.holes == Holes::as_given ? wanted : close_near_holes(loops, shiftable, wanted, curvature.log_scale);
  for (std::size_t i = 0; i < loop_count; ++i)
    curvature.needs_no_cut[i] = reached[i] && *reached[i] == once_around_a_hole;
}

}  // namespace lsgp
