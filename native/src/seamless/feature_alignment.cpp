// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_alignment.hpp"

#include <algorithm>
#include <complex>
#include <numeric>
#include <optional>
#include <utility>

#include "lsgp/errors.hpp"
#include "repair/line_constraints.hpp"
#include "seamless/aligned_lines.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

constexpr int most_attempts = 24;              // to align lines
constexpr Index attempted_triangles = 200000;  // in all attempts together; the first is always made
constexpr Index retried_triangles = 40000;     // in those for what was released
constexpr int most_fits = 300;                 // to find lines that contradict each other
constexpr Index fitted_triangles = 20000;      // in all of them together; ten times as many align no more on 45 models
constexpr double least_length = 0.1;           // of an edge, relative to the map without lines, that contradicts none
constexpr double compatible_share = 0.01;      // that lines may flip which contradict none

Array<FeatureLine> chosen_of(const Array<FeatureLine>& lines, const Array<char>& chosen) {
  Array<FeatureLine> out;
  for (Index k = 0; k < ssize(lines); ++k) {
    if (chosen[k]) out.push_back(lines[k]);
  }
  return out;
}

// The ranges of lines that have precedence over the lines behind them.
Array<std::pair<Index, Index>> ranks_of(const Array<FeatureLine>& lines) {
  const auto rank = [&](Index k) { return std::pair(lines[k].is_marked, lines[k].comes_last); };
  Array<std::pair<Index, Index>> out;
  for (Index begin = 0, end = 0; begin < ssize(lines); begin = end) {
    while (end < ssize(lines) && rank(end) == rank(begin)) ++end;
    out.emplace_back(begin, end);
  }
  return out;
}

class FeatureAligner {
 public:
  FeatureAligner(const FeatureTask& task, const Eigen::VectorXcd& start, const AlignmentBounds& bounds)
      : task_(task), unaligned_(start), bounds_(bounds) {}

  FeatureAlignment align_all(const PerHalfedge<char>& feature);

 private:
  Array<FeatureLine> straight_already(const PerHalfedge<char>& feature) const;
  Array<FeatureLine> compatible(const Array<FeatureLine>& lines);
  void add_faultless(const Array<FeatureLine>& lines, Index begin, Index end, Array<char>& chosen);
  void add_compatible(const Array<FeatureLine>& lines, const Index* begin, const Index* end, Array<char>& chosen);
  Array<Index> contradicting(const Array<FeatureLine>& lines, const Array<char>& chosen);
  std::optional<Eigen::VectorXcd> fit(const DegreesOfFreedom& freedom) const;
  bool keeps_lengths(const FeatureLine& line, const Eigen::VectorXcd& position) const;
  void add(Array<FeatureLine> lines);
  void add_trimmed();
  void release_all(const Array<FeatureLine>& lines, ReleaseReason reason);
  // None if all of them run along axes then, otherwise why they do not.  defects: vertices where the map fails.
  std::optional<ReleaseReason> align(const Array<FeatureLine>& lines, Array<Index>& defects);
  double length_along(const Array<FeatureLine>& lines, const Eigen::VectorXcd& position) const;
  bool may_suffice() const { return possible_ >= needed_; }
  DegreesOfFreedom free_with(const Array<FeatureLine>& lines) const {
    return free_along(task_.surface, task_.reduction, edges_of(lines));
  }

  const FeatureTask& task_;
  Eigen::VectorXcd unaligned_;  // relaxed, with features near the axes
  const AlignmentBounds bounds_;
  Jacobians jacobians_;           // of it
  double needed_ = 0;             // length of lines
  double possible_ = 0;           // length of the lines that are chosen, or can still be
  int left_ = 0, fits_left_ = 0;  // attempts, and fits before them
  Array<FeatureLine> trimmed_;    // released at defects
  FeatureAlignment out_;
};

FeatureAlignment FeatureAligner::align_all(const PerHalfedge<char>& feature) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  out_.reasons.assign(mesh.halfedge_count(), ReleaseReason::contradiction);
  // With hundreds of cones and handles most copies depend on many unknowns.
  const Index size = std::max(mesh.triangle_count(), static_cast<Index>(ssize(task_.lattice.reduction.terms) / 2));
  left_ = std::clamp(attempted_triangles / size, 1, most_attempts);
  fits_left_ = std::clamp(fitted_triangles / size, 1, most_fits);
  // Close to an isometry, lines have nearly their final directions.
  const PerVertex<char> fixed(mesh.vertex_count(), 0);
  unaligned_ *= turn_to_features(task_.surface, feature, unaligned_, bounds_.least_common);
  const Array<FeatureLine> straight = straight_already(feature);
  task_.minimize(
      straight.empty() ? free_all(mesh, task_.surface.cut_mesh, task_.reduction, fixed) : free_with(straight),
      unaligned_);
  unaligned_ *= turn_to_features(task_.surface, feature, unaligned_, bounds_.least_common);
  const FeatureLines traced = trace_features(task_.surface, feature, task_.mark_cones(), unaligned_);
  for (const Index h : traced.curved) out_.reasons[h] = ReleaseReason::curved;
  jacobians_ = measure_jacobians(task_.surface, task_.surface.cut_mesh, unaligned_);
  const auto [length_of_marked, length_of_creases] = length_of(traced.straight);
  if (length_of_marked == 0) needed_ = bounds_.least_of_creases * length_of_creases;
  Array<FeatureLine> lines = compatible(traced.straight);
  possible_ = total_length(lines);
  const auto others = std::find_if(lines.begin(), lines.end(), [](const FeatureLine& line) { return !line.is_marked; });
  add({lines.begin(), others});
  add({others, lines.end()});
  if (may_suffice()) {
    add_trimmed();
  } else {
    release_all(std::exchange(out_.lines, {}), ReleaseReason::contradiction);
  }
  return std::move(out_);
}

// The marked features that are straight along the axes.
Array<FeatureLine> FeatureAligner::straight_already(const PerHalfedge<char>& feature) const {
  constexpr double rounding = 1e-9;  // radians
  Array<FeatureLine> out = trace_features(task_.surface, feature, task_.mark_cones(), unaligned_).straight;
  out.erase(std::remove_if(out.begin(), out.end(),
                           [](const FeatureLine& line) { return !line.is_marked || line.bend > rounding; }),
            out.end());
  return out;
}

// Lines that do not contradict each other, in their order, those of a higher rank before others. Where not all do, two
// ways of choosing are compared by length. Linear fits decide, which take a small part of the time of a map.
Array<FeatureLine> FeatureAligner::compatible(const Array<FeatureLine>& lines) {
  Array<char> chosen(lines.size(), 0);
  const int most = fits_left_;
  for (const auto& [begin, end] : ranks_of(lines)) {
    Array<Index> numbers(end - begin);
    std::iota(numbers.begin(), numbers.end(), begin);
    possible_ = total_length(lines);
    Array<char> by_halves = chosen;
    add_compatible(lines, numbers.data(), numbers.data() + numbers.size(), by_halves);
    if (std::count(by_halves.begin() + begin, by_halves.begin() + end, 0) > 0) {
      const int left = std::exchange(fits_left_, most / 2);
      possible_ = total_length(lines);
      Array<char> by_fault = chosen;
      add_faultless(lines, begin, end, by_fault);
      fits_left_ = left;
      if (length_of(chosen_of(lines, by_fault)) > length_of(chosen_of(lines, by_halves))) by_halves = by_fault;
    }
    chosen = std::move(by_halves);
  }
  return chosen_of(lines, chosen);
}

// As long as some of these lines contradict others, releases the more expensive half of those where a fit fails.
// Released ones are then added as far as possible.
void FeatureAligner::add_faultless(const Array<FeatureLine>& lines, Index begin, Index end, Array<char>& chosen) {
  std::fill(chosen.begin() + begin, chosen.begin() + end, 1);
  Array<Index> released;
  for (Array<Index> at_fault = contradicting(lines, chosen); !at_fault.empty();
       at_fault = contradicting(lines, chosen)) {
    at_fault.erase(at_fault.begin(), std::lower_bound(at_fault.begin(), at_fault.end(), begin));
    if (at_fault.empty()) break;
    if (fits_left_ <= 0) {
      std::fill(chosen.begin() + begin, chosen.begin() + end, 0);
      return;
    }
    for (auto k = at_fault.begin() + ssize(at_fault) / 2; k != at_fault.end(); ++k) {
      chosen[*k] = 0;
      released.push_back(*k);
    }
  }
  std::sort(released.begin(), released.end());
  add_compatible(lines, released.data(), released.data() + released.size(), chosen);
}

// Chooses as many of these as do not contradict chosen ones, the first before others: halves that do are divided again,
// as long as the lines that remain may suffice.
void FeatureAligner::add_compatible(const Array<FeatureLine>& lines, const Index* begin, const Index* end,
                                    Array<char>& chosen) {
  if (begin == end || fits_left_ <= 0 || !may_suffice()) return;
  Array<char> more = chosen;
  for (const Index* k = begin; k < end; ++k) more[*k] = 1;
  if (contradicting(lines, more).empty()) {
    chosen = std::move(more);
  } else if (end - begin > 1) {
    const Index* const middle = begin + (end - begin) / 2;
    add_compatible(lines, begin, middle, chosen);
    add_compatible(lines, middle, end, chosen);
  } else {
    possible_ -= lines[*begin].length;
  }
}

// The chosen lines on which edges collapse, or at which triangles are flipped where more are than repair can mend; all
// of them if there is no map.
Array<Index> FeatureAligner::contradicting(const Array<FeatureLine>& lines, const Array<char>& chosen) {
  --fits_left_;
  const Array<FeatureLine> tried = chosen_of(lines, chosen);
  Array<Index> number;
  for (Index k = 0; k < ssize(lines); ++k) {
    if (chosen[k]) number.push_back(k);
  }
  const std::optional<Eigen::VectorXcd> position = fit(free_with(tried));
  if (!position) return number;
  const HalfedgeMesh& mesh = task_.surface.mesh;
  PerVertex<char> is_flipped(mesh.vertex_count(), 0);
  const bool is_mendable = task_.flips_at_most(compatible_share, *position);
  for (Index f = 0; f < mesh.triangle_count() && !is_mendable; ++f) {
    if (task_.is_upright(f, *position)) continue;
    for (int c = 0; c < 3; ++c) is_flipped[mesh.triangles(f, c)] = 1;
  }
  Array<Index> out;
  for (Index i = 0; i < ssize(tried); ++i) {
    const auto is_at_flip = [&](Index h) { return is_flipped[mesh.origin(h)] || is_flipped[mesh.target(h)]; };
    const Array<Index>& edges = tried[i].halfedges;
    if (!keeps_lengths(tried[i], *position) || std::any_of(edges.begin(), edges.end(), is_at_flip)) {
      out.push_back(number[i]);
    }
  }
  return out.empty() && !is_mendable ? number : out;
}

// The map nearest to the one without lines; none where lines leave too little freedom.
std::optional<Eigen::VectorXcd> FeatureAligner::fit(const DegreesOfFreedom& freedom) const {
  try {
    task_.before_step();
    Eigen::VectorXcd position = FreedomSystem(task_.surface, freedom).fit(jacobians_);
    if (position.allFinite()) return position;
  } catch (const Error& error) {
    if (error.code() != Code::solver_failed) throw;
  }
  return std::nullopt;
}

// Whether no edge of it has collapsed or been reversed.
bool FeatureAligner::keeps_lengths(const FeatureLine& line, const Eigen::VectorXcd& position) const {
  const CutMesh& cut_mesh = task_.surface.cut_mesh;
  for (Index i = 0; i < ssize(line.halfedges); ++i) {
    const Index tail = cut_mesh.copy_of_corner[line.halfedges[i]];
    const Index head = cut_mesh.copy_of_corner[next(line.halfedges[i])];
    const double along = std::real(std::conj(line.directions[i]) * (position[head] - position[tail]));
    if (!(along > least_length * std::abs(unaligned_[head] - unaligned_[tail]))) return false;
  }
  return true;
}

// All of them, or else as many as possible: lines that fail at a few places are released there, at first their edges
// and where that does not help whole lines, and otherwise halves that fail are divided again.
void FeatureAligner::add(Array<FeatureLine> lines) {
  std::optional<ReleaseReason> reason = ReleaseReason::contradiction;
  LineFailure failure;
  // Halves need attempts, too.
  const int most = left_ / 2;
  for (int trimmings = 0; reason; ++trimmings) {
    if (lines.empty() || left_ == 0 || !may_suffice()) return;
    const Array<Index> before = std::exchange(failure.vertices, {});
    reason = align(lines, failure.vertices);
    const bool is_stuck = failure.vertices == before;
    if (trimmings == most || (is_stuck && failure.is_of_lines)) break;
    failure.is_of_lines = is_stuck;
    if (!trim(task_.surface, failure, lines, &trimmed_)) break;
  }
  if (!reason) return;
  release_all(lines, *reason);
  if (lines.size() == 1) {
    possible_ -= lines.front().length;
    return;
  }
  const auto middle = lines.begin() + ssize(lines) / 2;
  add({lines.begin(), middle});
  add({middle, lines.end()});
}

// Most of what was released at defects can often be aligned all the same.
void FeatureAligner::add_trimmed() {
  Array<FeatureLine> lines = std::exchange(trimmed_, {});
  std::stable_sort(lines.begin(), lines.end(), [](const FeatureLine& a, const FeatureLine& b) {
    return std::pair(a.is_marked, a.length) > std::pair(b.is_marked, b.length);
  });
  left_ = std::min(left_, retried_triangles / task_.surface.mesh.triangle_count());
  for (const FeatureLine& line : lines) {
    if (left_ <= 0) return;
    Array<Index> defects;
    align({line}, defects);
  }
}

void FeatureAligner::release_all(const Array<FeatureLine>& lines, ReleaseReason reason) {
  for (const FeatureLine& line : lines) {
    for (const Index h : line.halfedges) release(h, reason, out_.reasons);
  }
}

std::optional<ReleaseReason> FeatureAligner::align(const Array<FeatureLine>& lines, Array<Index>& defects) {
  --left_;
  Array<FeatureLine> more = out_.lines;
  more.insert(more.end(), lines.begin(), lines.end());
  const DegreesOfFreedom freedom = free_with(more);
  std::optional<Eigen::VectorXcd> position = fit(freedom);
  if (!position) return ReleaseReason::contradiction;
  if (!task_.minimize(freedom, *position)) {
    defects = task_.defects_of(*position);
    return ReleaseReason::contradiction;
  }
  if (l2_stretch(task_.surface.geometry, measure_jacobians(task_.surface, task_.surface.cut_mesh, *position)) >
      bounds_.most_l2) {
    return ReleaseReason::stretch;
  }
  // Unfolding may turn a map in which much was flipped upside down.
  if (length_along(more, *position) < 0) *position = -*position;
  out_.lines = std::move(more);
  out_.start = std::move(*position);
  return std::nullopt;
}

// The length of lines in a map; reversed ones count negative.
double FeatureAligner::length_along(const Array<FeatureLine>& lines, const Eigen::VectorXcd& position) const {
  const DirectedEdges edges = edges_of(lines);
  const auto at = [&](Index corner) { return position[task_.surface.cut_mesh.copy_of_corner[corner]]; };
  double out = 0;
  for (Index i = 0; i < ssize(edges.halfedges); ++i) {
    const Index h = edges.halfedges[i];
    out += std::real(std::conj(edges.directions[i]) * (at(next(h)) - at(h)));
  }
  return out;
}

}  // namespace

FeatureAlignment align_with_axes(const FeatureTask& task, const PerHalfedge<char>& feature,
                                 const Eigen::VectorXcd& start, const AlignmentBounds& bounds) {
  return FeatureAligner(task, start, bounds).align_all(feature);
}

}  // namespace lsgp
