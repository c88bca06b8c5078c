// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_layout.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "creases/features.hpp"
#include "lsgp/errors.hpp"
#include "repair/low_stretch.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr int most_attempts = 24;              // to align lines
constexpr Index attempted_triangles = 200000;  // in all attempts together; the first is always made
constexpr Index retried_triangles = 40000;     // in those for what was released
constexpr int most_fits = 300;                 // to find lines that contradict each other
constexpr Index fitted_triangles = 200000;     // in all of them together
constexpr double least_length = 0.1;           // of an edge, relative to the map without lines, that contradicts none
constexpr double mendable_share = 0.1;         // of the triangles, flipped, that are repaired
constexpr int most_trimmings = 4;              // of lines whose layout on the lattice fails at a few places
constexpr int most_rings = 4;                  // of triangles from where lines fail to the next line
constexpr Index most_defects = 24;             // vertices there, on small meshes
constexpr double defective_share = 0.02;       // of the vertices, on others
constexpr double least_kept = 0.25;            // of their length on a lattice
constexpr double most_cost = 0.25;             // of rounding, relative to the area: beyond, layouts fold or stretch
constexpr double most_cost_of_corners = 0.05;  // besides
constexpr double compatible_share = 0.01;      // that lines may flip which contradict none
constexpr Index few = 8;                       // that are always
constexpr int unfolding_steps = 16;
constexpr int relaxing_steps = 30;
constexpr double least_decrease = 1e-3;           // of the energy, for which a further step is taken
constexpr double fine_step = 1.0 / 256;           // exact in single precision on any grid
constexpr double short_length = 1.5;              // cells: what is rounded first
constexpr std::ptrdiff_t most_distances = 256;    // between lines, the least ones
constexpr double least_slope = 0.6;               // sine of the angle to lines of an edge that keeps them apart
constexpr double least_response = 1e-9;           // of a coordinate to a shift, or to unknowns
constexpr double whole = 1e-5;                    // deviation of a dependent coordinate from its step
constexpr int tried_scales = 3;                   // above and below the one asked for, by sixteenths of an octave
constexpr std::ptrdiff_t many_coordinates = 512;  // for which only one scale is tried

CoordinateForm coordinate(Index of) { return {{of / 2, of % 2 == 0 ? Complex(0, 1) : Complex(1)}}; }

CoordinateForm difference(Index of, Index from) {
  CoordinateForm out = coordinate(of);
  out.emplace_back(from / 2, -coordinate(from).front().second);
  return out;
}

double coordinate_at(Index of, const Eigen::VectorXcd& position) {
  return of % 2 == 0 ? position[of / 2].real() : position[of / 2].imag();
}

void set_coordinate(Index of, double value, Eigen::VectorXcd& position) {
  Complex& at = position[of / 2];
  at = of % 2 == 0 ? Complex(value, at.imag()) : Complex(at.real(), value);
}

// Of marked lines, and of the others.
std::pair<double, double> length_of(const Array<FeatureLine>& lines) {
  std::pair<double, double> out(0, 0);
  for (const FeatureLine& line : lines) (line.is_marked ? out.first : out.second) += line.length;
  return out;
}

double total_length(const Array<FeatureLine>& lines) {
  const auto [of_marked, of_others] = length_of(lines);
  return of_marked + of_others;
}

Array<FeatureLine> chosen_of(const Array<FeatureLine>& lines, const Array<char>& chosen) {
  Array<FeatureLine> out;
  for (Index k = 0; k < ssize(lines); ++k) {
    if (chosen[k]) out.push_back(lines[k]);
  }
  return out;
}

// The ranges of lines that have precedence over the lines behind them.
Array<std::pair<Index, Index>> ranks_of(const Array<FeatureLine>& lines) {
  const auto rank = [&](Index k) { return std::pair(lines[k].is_marked, lines[k].is_part); };
  Array<std::pair<Index, Index>> out;
  for (Index begin = 0, end = 0; begin < ssize(lines); begin = end) {
    while (end < ssize(lines) && rank(end) == rank(begin)) ++end;
    out.emplace_back(begin, end);
  }
  return out;
}

// Marks the neighbors of marked vertices.
void grow(const HalfedgeMesh& mesh, PerVertex<char>& is_marked) {
  const PerVertex<char> inner = is_marked;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (inner[mesh.origin(h)]) is_marked[mesh.target(h)] = 1;
    if (inner[mesh.target(h)]) is_marked[mesh.origin(h)] = 1;
  }
}

}  // namespace

FeatureLayout::FeatureLayout(const FeatureTask& task, const PerHalfedge<char>& feature, const Eigen::VectorXcd& start,
                             double most_l2, std::optional<FeatureAlignment>& known)
    : task_(task),
      unaligned_(start),
      most_l2_(most_l2),
      reasons_(task.surface.mesh.halfedge_count(), ReleaseReason::contradiction) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  is_cone_.assign(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    is_cone_[v] = mesh.loop_of_vertex[v] == none && task_.curvature.at_vertex[v] != 0;
  }
  if (known) {
    aligned_ = known->lines;
    start_ = known->start;
    reasons_ = known->reasons;
  } else {
    align_all(feature);
    known = FeatureAlignment{aligned_, start_, reasons_};
  }
  aligned_length_ = total_length(aligned_);
  if (!aligned_.empty()) find_coordinates();
}

void FeatureLayout::align_all(const PerHalfedge<char>& feature) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  // With hundreds of cones and handles most copies depend on many unknowns.
  const Index size = std::max(mesh.triangle_count(), static_cast<Index>(ssize(task_.lattice.reduction.terms) / 2));
  left_ = std::clamp(attempted_triangles / size, 1, most_attempts);
  fits_left_ = std::clamp(fitted_triangles / size, 1, most_fits);
  // Close to an isometry, lines have nearly their final directions.
  held_ = free_all(mesh, task_.surface.cut_mesh, task_.lattice.reduction, PerVertex<char>(mesh.vertex_count(), 0));
  minimize(unaligned_);
  unaligned_ *= turn_to_features(task_.surface, feature, unaligned_);
  const FeatureLines traced = trace_features(task_.surface, feature, is_cone_, unaligned_);
  for (const Index h : traced.curved) reasons_[h] = ReleaseReason::curved;
  jacobians_ = measure_jacobians(task_.surface, task_.surface.cut_mesh, unaligned_);
  Array<FeatureLine> lines = compatible(traced.straight);
  const std::ptrdiff_t marked =
      std::count_if(lines.begin(), lines.end(), [](const FeatureLine& line) { return line.is_marked; });
  if (marked > 0) add(lines, 0, marked);
  add(lines, marked, ssize(lines));
  add_trimmed();
}

// Lines that do not contradict each other, in their order, those of a higher rank before others. Where not all do, two
// ways of choosing are compared by length. Linear fits decide, which take a small part of the time of a map.
Array<FeatureLine> FeatureLayout::compatible(const Array<FeatureLine>& lines) {
  Array<char> chosen(lines.size(), 0);
  const int most = fits_left_;
  for (const auto& [begin, end] : ranks_of(lines)) {
    Array<Index> numbers(end - begin);
    std::iota(numbers.begin(), numbers.end(), begin);
    Array<char> by_halves = chosen;
    add_compatible(lines, numbers.data(), numbers.data() + numbers.size(), by_halves);
    if (std::count(by_halves.begin() + begin, by_halves.begin() + end, 0) > 0) {
      const int left = std::exchange(fits_left_, most / 2);
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
void FeatureLayout::add_faultless(const Array<FeatureLine>& lines, Index begin, Index end, Array<char>& chosen) {
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

// Chooses as many of these as do not contradict chosen ones, the first before others: halves that do are divided again.
void FeatureLayout::add_compatible(const Array<FeatureLine>& lines, const Index* begin, const Index* end,
                                   Array<char>& chosen) {
  if (begin == end || fits_left_ <= 0) return;
  Array<char> more = chosen;
  for (const Index* k = begin; k < end; ++k) more[*k] = 1;
  if (contradicting(lines, more).empty()) {
    chosen = std::move(more);
  } else if (end - begin > 1) {
    const Index* const middle = begin + (end - begin) / 2;
    add_compatible(lines, begin, middle, chosen);
    add_compatible(lines, middle, end, chosen);
  }
}

// The chosen lines on which edges collapse, or at which triangles are flipped where more are than repair can mend; all
// of them if there is no map.
Array<Index> FeatureLayout::contradicting(const Array<FeatureLine>& lines, const Array<char>& chosen) {
  --fits_left_;
  const Array<FeatureLine> tried = chosen_of(lines, chosen);
  Array<Index> number;
  for (Index k = 0; k < ssize(lines); ++k) {
    if (chosen[k]) number.push_back(k);
  }
  const std::optional<Eigen::VectorXcd> position =
      fit(free_along(task_.surface, task_.lattice.reduction, edges_of(tried)));
  if (!position) return number;
  const HalfedgeMesh& mesh = task_.surface.mesh;
  PerVertex<char> is_flipped(mesh.vertex_count(), 0);
  const bool is_mendable = flips_at_most(compatible_share, *position);
  for (Index f = 0; f < mesh.triangle_count() && !is_mendable; ++f) {
    if (is_upright(f, *position)) continue;
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
std::optional<Eigen::VectorXcd> FeatureLayout::fit(const DegreesOfFreedom& freedom) const {
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
bool FeatureLayout::keeps_lengths(const FeatureLine& line, const Eigen::VectorXcd& position) const {
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
void FeatureLayout::add(Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end) {
  std::optional<ReleaseReason> reason = ReleaseReason::contradiction;
  Failure failure;
  // Halves need attempts, too.
  const int most = left_ / 2;
  for (int trimmings = 0; reason; ++trimmings) {
    if (begin == end || left_ == 0) return;
    const Array<Index> before = std::exchange(failure.vertices, {});
    reason = align(lines, begin, end, failure.vertices);
    const bool is_stuck = failure.vertices == before;
    if (trimmings == most || (is_stuck && failure.is_of_lines)) break;
    failure.is_of_lines = is_stuck;
    if (!trim(failure, lines, begin, end, &trimmed_)) break;
  }
  if (!reason) return;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    for (const Index h : lines[i].halfedges) release(h, *reason);
  }
  if (end - begin == 1) return;
  const std::ptrdiff_t middle = begin + (end - begin) / 2;
  add(lines, begin, middle);
  add(lines, middle, end);
}

// Most of what was released at defects can often be aligned all the same.
void FeatureLayout::add_trimmed() {
  Array<FeatureLine> lines = std::exchange(trimmed_, {});
  std::stable_sort(lines.begin(), lines.end(), [](const FeatureLine& a, const FeatureLine& b) {
    return std::pair(a.is_marked, a.length) > std::pair(b.is_marked, b.length);
  });
  left_ = std::min(left_, retried_triangles / task_.surface.mesh.triangle_count());
  for (std::ptrdiff_t k = 0; k < ssize(lines) && left_ > 0; ++k) {
    Array<Index> defects;
    align(lines, k, k + 1, defects);
  }
}

// Corners that a curved line would get are the reason why it cannot be aligned.
void FeatureLayout::release(Index h, ReleaseReason reason) {
  if (reasons_[h] != ReleaseReason::curved) reasons_[h] = reason;
}

// Whether releasing edges at these vertices can help.
bool FeatureLayout::are_few(const Array<Index>& vertices) const {
  const auto share = static_cast<Index>(defective_share * task_.surface.mesh.vertex_count());
  return ssize(vertices) <= std::max(most_defects, share);
}

// Releases the edges of lines, or the whole lines, at vertices where they failed, or where no line is, at vertices near
// these; whether there are any, and others left. No distance between cones follows from what is left of a line.
// released: gets the edges, if wanted.
bool FeatureLayout::trim(const Failure& failure, Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end,
                         Array<FeatureLine>* released) const {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  if (failure.vertices.empty() || !are_few(failure.vertices)) return false;
  PerVertex<char> is_marked(mesh.vertex_count(), 0);
  for (const Index v : failure.vertices) is_marked[v] = 1;
  const auto is_released = [&](Index h) { return is_marked[mesh.origin(h)] || is_marked[mesh.target(h)]; };
  const auto is_trimmed = [&](const FeatureLine& line) {
    return std::any_of(line.halfedges.begin(), line.halfedges.end(), is_released);
  };
  for (int ring = 0; ring < most_rings && std::none_of(lines.begin() + begin, lines.begin() + end, is_trimmed);
       ++ring) {
    grow(mesh, is_marked);
  }
  bool has_released = false, has_others = false;
  for (std::ptrdiff_t k = begin; k < end; ++k) {
    const bool is_lost = failure.is_of_lines && is_trimmed(lines[k]);
    const auto is_gone = [&](Index h) { return is_lost || is_released(h); };
    const FeatureLine line = std::exchange(lines[k], part_of(lines[k], [&](Index h) { return !is_gone(h); }));
    has_others = has_others || !lines[k].halfedges.empty();
    if (lines[k].is_whole || lines[k].halfedges.size() == line.halfedges.size()) continue;
    has_released = true;
    if (released != nullptr) released->push_back(part_of(line, is_gone));
  }
  return has_released && has_others;
}

std::optional<ReleaseReason> FeatureLayout::align(const Array<FeatureLine>& lines, std::ptrdiff_t begin,
                                                  std::ptrdiff_t end, Array<Index>& defects) {
  --left_;
  Array<FeatureLine> more = aligned_;
  more.insert(more.end(), lines.begin() + begin, lines.begin() + end);
  DegreesOfFreedom freedom = free_along(task_.surface, task_.lattice.reduction, edges_of(more));
  std::optional<Eigen::VectorXcd> position = fit(freedom);
  if (!position) return ReleaseReason::contradiction;
  held_ = std::move(freedom);
  if (!minimize(*position)) {
    defects = defects_of(*position);
    return ReleaseReason::contradiction;
  }
  if (l2_stretch(task_.surface.geometry, measure_jacobians(task_.surface, task_.surface.cut_mesh, *position)) >
      most_l2_) {
    return ReleaseReason::stretch;
  }
  // Unfolding may turn a map in which much was flipped upside down.
  if (length_along(more, *position) < 0) *position = -*position;
  aligned_ = std::move(more);
  start_ = std::move(*position);
  return std::nullopt;
}

// The length of lines in a map; reversed ones count negative.
double FeatureLayout::length_along(const Array<FeatureLine>& lines, const Eigen::VectorXcd& position) const {
  const DirectedEdges edges = edges_of(lines);
  const auto at = [&](Index corner) { return position[task_.surface.cut_mesh.copy_of_corner[corner]]; };
  double out = 0;
  for (Index i = 0; i < ssize(edges.halfedges); ++i) {
    const Index h = edges.halfedges[i];
    out += std::real(std::conj(edges.directions[i]) * (at(next(h)) - at(h)));
  }
  return out;
}

// The vertices of flipped triangles, and those with wrong angle sums, sorted.
Array<Index> FeatureLayout::defects_of(const Eigen::VectorXcd& position) const {
  const Validity validity = validity_of(position);
  Array<Index> out = validity.wrong_angle_sums;
  for (const Index f : validity.flipped) {
    for (int c = 0; c < 3; ++c) out.push_back(task_.surface.mesh.triangles(f, c));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

FeatureLine FeatureLayout::part_of(const FeatureLine& line, const std::function<bool(Index)>& is_in) const {
  FeatureLine out = line;
  out.halfedges.clear();
  out.directions.clear();
  out.length = 0;
  for (Index i = 0; i < ssize(line.halfedges); ++i) {
    const Index h = line.halfedges[i];
    if (!is_in(h)) continue;
    out.halfedges.push_back(h);
    out.directions.push_back(line.directions[i]);
    out.length += task_.surface.geometry.length[h];
  }
  out.is_whole = line.is_whole && out.halfedges.size() == line.halfedges.size();
  return out;
}

// Single edges are released a few times, and independently of that whole lines.
void FeatureLayout::find_loosened() {
  const Array<Index> defects = std::exchange(lattice_defects_, {});
  const int trimmings = trimmings_;
  Loosened trimmed{aligned_, start_, trimmings + 1};
  if (trimmings >= 0 && trimmings < most_trimmings &&
      trim({defects, false}, trimmed.lines, 0, ssize(trimmed.lines), nullptr)) {
    loosened_.push_back(std::move(trimmed));
  }
  if (trimmings > 0) return;
  Loosened shortened{aligned_, start_, -1};
  Array<FeatureLine>& lines = shortened.lines;
  // Layouts that keep less are not worth their time.
  const auto is_enough = [&] { return total_length(lines) > least_kept * aligned_length_; };
  lines.erase(std::remove_if(lines.begin(), lines.end(), [](const FeatureLine& line) { return line.is_part; }),
              lines.end());
  if (lines.size() == aligned_.size() || !is_enough()) {
    lines = aligned_;
    lines.resize(5 * lines.size() / 6);
  }
  if (is_enough()) loosened_.push_back(std::move(shortened));
}

bool FeatureLayout::loosen() {
  const Array<FeatureLine> before = aligned_;
  find_loosened();
  do {
    if (loosened_.empty()) return false;
    const auto longest = std::max_element(loosened_.begin(), loosened_.end(), [](const auto& a, const auto& b) {
      return length_of(a.lines) < length_of(b.lines);
    });
    aligned_ = std::move(longest->lines);
    start_ = std::move(longest->start);
    trimmings_ = longest->trimmings;
    loosened_.erase(longest);
    keeps_corners_ = false;
    held_ = free_along(task_.surface, task_.lattice.reduction, edges_of(aligned_));
    // It fulfills the conditions that are left, and stays valid.
    relax(Eigen::VectorXd::Ones(task_.surface.mesh.triangle_count()), start_);
  } while (!is_valid(start_));
  if (trimmings_ < 0) hopeless_scale_ = 0;
  PerHalfedge<char> is_kept(task_.surface.mesh.halfedge_count(), 0);
  for (const Index h : edges_of(aligned_).halfedges) is_kept[h] = 1;
  for (const FeatureLine& line : before) {
    for (const Index h : line.halfedges) {
      if (!is_kept[h]) release(h, ReleaseReason::lattice);
    }
  }
  lines_.clear();
  rounded_.clear();
  held_translation_.clear();
  find_coordinates();
  return true;
}

DirectedEdges FeatureLayout::edges_of(const Array<FeatureLine>& lines) const {
  DirectedEdges out;
  for (const FeatureLine& line : lines) {
    out.halfedges.insert(out.halfedges.end(), line.halfedges.begin(), line.halfedges.end());
    out.directions.insert(out.directions.end(), line.directions.begin(), line.directions.end());
  }
  return out;
}

// What the lattice rounds, as coordinates of the copies.
void FeatureLayout::find_lattice_coordinates() {
  const auto& [surface, curvature, rotation, lattice, before_step] = task_;
  Array<Array<std::pair<Index, Complex>>> integer;
  for (const Index v : lattice.cones) integer.push_back({{v, 1.0}});
  for (const Index p : lattice.cuts) {
    const Sisters sisters = origin_sisters(surface.mesh, surface.cut_mesh, surface.cut_graph.cuts[p].halfedges.front());
    integer.push_back({{sisters.right, 1.0}, {sisters.left, -std::polar(1.0, rotation[p])}});
  }
  for (const FeatureLine& line : aligned_) {
    if (!line.is_whole) continue;
    const Index tail = surface.mesh.origin(line.halfedges.front()), head = surface.mesh.target(line.halfedges.back());
    if (!is_cone_[tail] || !is_cone_[head]) continue;
    CoordinateForm length;
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index h = line.halfedges[i];
      const Complex along = Complex(0, 1) * std::conj(line.directions[i]);
      length.emplace_back(surface.cut_mesh.copy_of_corner[next(h)], along);
      length.emplace_back(surface.cut_mesh.copy_of_corner[h], -along);
    }
    // Unfolding may have reversed a line.
    if (value_of(length, start_) < 0) {
      for (auto& term : length) term.second = -term.second;
    }
    rounded_.push_back(std::move(length));
  }
  length_count_ = ssize(rounded_);
  const Eigen::MatrixXcd inverse = lattice.basis.inverse();
  for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
    for (const Complex part : {Complex(0, 1), Complex(1)}) {
      CoordinateForm form;
      for (Eigen::Index l = 0; l < inverse.cols(); ++l) {
        if (inverse(k, l) == 0.0) continue;
        for (const auto& [copy, factor] : integer[l]) form.emplace_back(copy, part * inverse(k, l) * factor);
      }
      rounded_.push_back(std::move(form));
    }
  }
  lattice_count_ = ssize(rounded_);
  may_shift_ = lattice.origin == none && (rotation.array() == 0).all();
  if (lattice.origin == none && !may_shift_) hold_translation();
}

// Without a cone at the origin, shifts of the layout cost nothing; where cuts turn, they change translations. One of
// these becomes 0 by a shift and stays so; the compliance would be unbounded otherwise.
void FeatureLayout::hold_translation() {
  const Eigen::VectorXcd right = Eigen::VectorXcd::Ones(start_.size()), up = Complex(0, 1) * right;
  for (std::ptrdiff_t i = length_count_; i < lattice_count_; i += 2) {
    Eigen::Matrix2d change;
    Eigen::Vector2d value;
    for (const int part : {0, 1}) {
      change.row(part) << value_of(rounded_[i + part], right), value_of(rounded_[i + part], up);
      value[part] = value_of(rounded_[i + part], start_);
    }
    if (!(std::abs(change.determinant()) > least_response)) continue;
    const Eigen::Vector2d shift = change.inverse() * value;
    start_.array() -= Complex(shift[0], shift[1]);
    held_translation_ = {rounded_[i], rounded_[i + 1]};
    return;
  }
}

// Cones are on the lattice anyway, and closed lines have no ends.
void FeatureLayout::find_corners(const Array<char>& is_on_line) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  Array<char> is_listed = is_on_line;
  const auto list = [&](Index corner, Complex direction) {
    const Index along = 2 * task_.surface.cut_mesh.copy_of_corner[corner] + (direction.imag() == 0 ? 0 : 1);
    if (is_cone_[mesh.origin(corner)] || std::exchange(is_listed[along], 1)) return;
    rounded_.push_back(coordinate(along));
  };
  const auto edge = [&](Index h) {
    return Eigen::Vector3d(mesh.positions.row(mesh.target(h)) - mesh.positions.row(mesh.origin(h))).normalized();
  };
  for (const FeatureLine& line : aligned_) {
    if (line.is_whole && mesh.origin(line.halfedges.front()) != mesh.target(line.halfedges.back())) {
      list(line.halfedges.front(), line.directions.front());
      list(next(line.halfedges.back()), line.directions.back());
    }
    for (Index i = 1; i < ssize(line.halfedges); ++i) {
      const Index before = line.halfedges[i - 1], h = line.halfedges[i];
      if (mesh.target(before) != mesh.origin(h)) continue;  // released edges are between them
      if (edge(before).dot(edge(h)) < std::cos(crease_angle)) list(h, line.directions[i]);
    }
  }
}

// The least distances between parallel lines, or from a line to a cone, that should not vanish: with the height of a
// triangle it vanishes itself, and an edge that is far from parallel to them would turn much.
void FeatureLayout::find_distances(const DirectedEdges& edges, const Array<char>& is_on_line, UnionFind& same) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  const Array<Index>& copy = task_.surface.cut_mesh.copy_of_corner;
  const auto edge = [&](Index h) { return start_[copy[next(h)]] - start_[copy[h]]; };
  std::map<std::pair<Index, Index>, std::pair<double, CoordinateForm>> found;  // of lines or cones
  const auto list_if_known = [&](Index corner, Index other, int axis) {
    Index a = 2 * copy[corner] + axis, b = 2 * copy[other] + axis;
    if (!(is_on_line[a] || is_cone_[mesh.origin(corner)]) || !(is_on_line[b] || is_cone_[mesh.origin(other)])) return;
    if (coordinate_at(b, start_) < coordinate_at(a, start_)) std::swap(a, b);
    const double distance = coordinate_at(b, start_) - coordinate_at(a, start_);
    found.try_emplace(std::minmax({same.find(a), same.find(b)}), distance, difference(b, a));
  };
  for (const Index on_line : edges.halfedges) {
    for (const Index h : {on_line, mesh.twin[on_line]}) {
      if (h == none) continue;
      const Complex along = edge(h);
      list_if_known(h, prev(h), std::abs(along.real()) > std::abs(along.imag()) ? 1 : 0);
    }
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Complex along = edge(h);
    const double steep = least_slope * std::abs(along);
    if (std::abs(along.real()) > steep) list_if_known(h, next(h), 0);
    if (std::abs(along.imag()) > steep) list_if_known(h, next(h), 1);
  }
  Array<std::pair<double, CoordinateForm>> distances;
  for (auto& [lines, distance] : found) distances.push_back(std::move(distance));
  std::stable_sort(distances.begin(), distances.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (ssize(distances) > most_distances) distances.resize(most_distances);
  for (auto& [distance, form] : distances) rounded_.push_back(std::move(form));
  distance_count_ = ssize(rounded_);
}

void FeatureLayout::find_coordinates() {
  const CutMesh& cut_mesh = task_.surface.cut_mesh;
  const DirectedEdges edges = edges_of(aligned_);
  UnionFind same(2 * cut_mesh.copy_count());
  Array<char> is_on_line(2 * cut_mesh.copy_count(), 0);
  for (Index i = 0; i < ssize(edges.halfedges); ++i) {
    const Index tail = cut_mesh.copy_of_corner[edges.halfedges[i]];
    const Index head = cut_mesh.copy_of_corner[next(edges.halfedges[i])];
    const Index across = edges.directions[i].imag() == 0 ? 1 : 0;
    same.unite(2 * tail + across, 2 * head + across);
    is_on_line[2 * tail + across] = is_on_line[2 * head + across] = 1;
  }
  Array<Index> number(2 * cut_mesh.copy_count(), none);
  for (Index of = 0; of < ssize(number); ++of) {
    if (!is_on_line[of]) continue;
    Index& line = number[same.find(of)];
    if (line == none) {
      line = static_cast<Index>(lines_.size());
      lines_.emplace_back();
    }
    lines_[line].push_back(of);
  }
  find_lattice_coordinates();
  find_distances(edges, is_on_line, same);
  Array<Index> reference(2, none);
  for (const Array<Index>& line : lines_) {
    Index& first = reference[line.front() % 2];
    if (may_shift_ && first == none) {
      first = line.front();
    } else {
      rounded_.push_back(may_shift_ ? difference(line.front(), first) : coordinate(line.front()));
    }
  }
  line_count_ = ssize(rounded_);
  // Shifts round others, to which corners would have to be related.
  if (!may_shift_) find_corners(is_on_line);
  const Reduction& reduction = task_.lattice.reduction;
  DirectedEdges fixed = edges;
  fixed.fixed = held_translation_;
  system_.emplace(task_.surface, free_along(task_.surface, reduction, fixed));
  factor_.emplace(system_->dirichlet().triangularView<Eigen::Lower>());
  coefficients_.resize(system_->dirichlet().rows(), ssize(rounded_));
  for (std::ptrdiff_t i = 0; i < ssize(rounded_); ++i) {
    const Eigen::VectorXd column = system_->coefficients_of(rounded_[i]);
    coefficients_.startVec(i);
    if (column.cwiseAbs().maxCoeff() < least_response) continue;  // held
    for (Eigen::Index row = 0; row < column.size(); ++row) {
      if (column[row] != 0) coefficients_.insertBack(row, i) = column[row];
    }
  }
  coefficients_.finalize();
  compliance_.resize(ssize(rounded_), ssize(rounded_));
  constexpr Eigen::Index at_once = 16;
  for (Eigen::Index i = 0; i < compliance_.cols(); i += at_once) {
    const Eigen::Index width = std::min(at_once, compliance_.cols() - i);
    const Eigen::MatrixXd forces(coefficients_.middleCols(i, width));
    compliance_.middleCols(i, width) = coefficients_.transpose() * factor_->solve(forces);
  }
  const auto of_lines = compliance_.topLeftCorner(line_count_, line_count_);
  whole_values_ = WholeValues::among(of_lines);
  Eigen::VectorXd units = Eigen::VectorXd::Ones(line_count_);
  units.tail(line_count_ - lattice_count_).setConstant(1 / fine_step);
  fine_values_ = WholeValues::among(units.asDiagonal() * of_lines * units.asDiagonal());
  fixed.fixed = rounded_;
  held_corners_ = free_along(task_.surface, reduction, fixed);
  fixed.fixed.resize(line_count_);
  held_ = free_along(task_.surface, reduction, fixed);
}

// Rounds one coordinate after the other, the cheapest first; the others follow.
std::optional<FeatureLayout::Choice> FeatureLayout::round(double scale, bool is_fine) const {
  const std::optional<WholeValues>& all = is_fine ? fine_values_ : whole_values_;
  if (!all) return std::nullopt;
  WholeValues values = *all;
  const std::ptrdiff_t count = line_count_;
  Choice out{scale, {}, {}, {}, 0};
  Eigen::VectorXd value(ssize(rounded_));
  for (std::ptrdiff_t i = 0; i < value.size(); ++i) value[i] = scale * value_of(rounded_[i], start_);
  PivotedCholesky cholesky(compliance_);
  Array<char> is_done(count, 0);
  const auto unit = [&](std::ptrdiff_t i) { return is_fine && i >= lattice_count_ ? fine_step : 1.0; };
  const auto may_vanish = [&](std::ptrdiff_t i) {
    return i < length_count_ || (i >= lattice_count_ && i < distance_count_);
  };
  const auto least = [&](std::ptrdiff_t i) {
    return may_vanish(i) ? unit(i) : -std::numeric_limits<double>::infinity();
  };
  const auto off = [&](std::ptrdiff_t i) {
    return std::max(unit(i) * std::round(value[i] / unit(i)), least(i)) - value[i];
  };
  // Short lengths and distances come first, so that they do not vanish; where lines need not be on the lattice, they
  // wait for it.
  enum class Stage { vanishing, on_lattice, all };
  for (const Stage stage : {Stage::vanishing, Stage::on_lattice, Stage::all}) {
    const std::ptrdiff_t end = is_fine && stage != Stage::all ? lattice_count_ : count;

    for (;;) {
      checkpoint(static_cast<double>(count * (ssize(out.independent) + 1)));
      std::ptrdiff_t best = -1;
      double cheapest = std::numeric_limits<double>::infinity();
      for (std::ptrdiff_t i = 0; i < end; ++i) {
        if (is_done[i] || !cholesky.is_independent(i)) continue;
        if (stage == Stage::vanishing && !(may_vanish(i) && value[i] <= short_length)) continue;
        const double cost = off(i) * off(i) / cholesky.left()[i];
        if (!(cost < cheapest)) continue;
        cheapest = cost;
        best = i;
      }
      if (best < 0) break;
      is_done[best] = 1;
      const double step = values.isolate(best);
      const double to = values.nearest(best, step, value[best] / unit(best), least(best));
      if (!values.fix(best, step, to)) return std::nullopt;
      const double by = unit(best) * to - value[best];
      const Eigen::VectorXd column = cholesky.column(best);
      value += column * (by / column[best]);
      out.cost += by * by / column[best];
      cholesky.eliminate(best, column);
      out.independent.push_back(static_cast<Index>(best));
    }
  }
  for (std::ptrdiff_t i = 0; i < length_count_; ++i) {
    if (value[i] < 1 - whole) return std::nullopt;
  }
  if (keeps_corners_ && !is_fine) round_corners(value, cholesky, out);
  const Eigen::Index chosen = ssize(out.independent);
  Eigen::MatrixXd block(chosen, chosen);
  Eigen::VectorXd moved(chosen);
  for (Eigen::Index k = 0; k < chosen; ++k) {
    const Index i = out.independent[k];
    moved[k] = value[i] - scale * value_of(rounded_[i], start_);
    for (Eigen::Index l = 0; l < chosen; ++l) block(k, l) = compliance_(i, out.independent[l]);
  }
  out.pull = block.ldlt().solve(moved);
  out.values = std::move(value);
  return out;
}

// The cheapest ones, of those that do not follow from other coordinates.
void FeatureLayout::round_corners(Eigen::VectorXd& value, PivotedCholesky& cholesky, Choice& choice) const {
  double left = most_cost_of_corners * choice.scale * choice.scale * task_.surface.geometry.total_area;
  for (;;) {
    checkpoint(static_cast<double>(value.size() * (ssize(choice.independent) + 1)));
    std::ptrdiff_t best = -1;
    double cheapest = left;
    for (std::ptrdiff_t i = line_count_; i < value.size(); ++i) {
      if (!cholesky.is_independent(i)) continue;
      const double off = std::round(value[i]) - value[i], cost = off * off / cholesky.left()[i];
      if (!(cost < cheapest)) continue;
      cheapest = cost;
      best = i;
    }
    if (best < 0) return;
    left -= cheapest;
    const Eigen::VectorXd column = cholesky.column(best);
    value += column * ((std::round(value[best]) - value[best]) / column[best]);
    cholesky.eliminate(best, column);
    choice.independent.push_back(static_cast<Index>(best));
  }
}

std::optional<Eigen::VectorXcd> FeatureLayout::quantize(double density, bool must_be_whole, bool keeps_corners,
                                                        const std::function<bool(const Eigen::VectorXcd&)>& accepts) {
  keeps_corners_ = keeps_corners;
  const std::optional<Choice> whole_lines = choose(density, false);
  const auto is_of_corner = [&](Index i) { return i >= line_count_; };
  if (keeps_corners && whole_lines &&
      std::none_of(whole_lines->independent.begin(), whole_lines->independent.end(), is_of_corner)) {
    return std::nullopt;
  }
  if (whole_lines) {
    auto out = lay_out(*whole_lines, 1);
    if (out && accepts(*out)) return out;
  }
  if (must_be_whole) return std::nullopt;
  const std::optional<Choice> fine_lines = choose(density, true);
  if (!fine_lines) return std::nullopt;
  // The same values would fail in the same way.
  if (whole_lines && whole_lines->scale == fine_lines->scale &&
      (whole_lines->values - fine_lines->values).isZero(whole)) {
    return std::nullopt;
  }
  auto out = lay_out(*fine_lines, fine_step);
  return out && accepts(*out) ? out : std::nullopt;
}

// The cheapest one of some scales about this one.
std::optional<FeatureLayout::Choice> FeatureLayout::choose(double density, bool is_fine) const {
  std::optional<Choice> best;
  double least = std::numeric_limits<double>::infinity();
  const int scales = line_count_ - (distance_count_ - lattice_count_) > many_coordinates ? 0 : tried_scales;
  for (int k = -scales; k <= scales; ++k) {
    const double growth = k * M_LN2 / 16;
    std::optional<Choice> choice = round(density * std::exp(growth), is_fine);
    if (!choice) continue;
    const double cost =
        choice->cost / (choice->scale * choice->scale) + 2 * task_.surface.geometry.total_area * growth * growth;
    if (!(cost < least)) continue;
    least = cost;
    best = std::move(choice);
  }
  return best;
}

std::optional<Eigen::VectorXcd> FeatureLayout::lay_out(const Choice& choice, double step_of_lines) {
  const bool is_expensive = choice.cost > most_cost * choice.scale * choice.scale * task_.surface.geometry.total_area;
  if (is_expensive || choice.scale <= hopeless_scale_) return std::nullopt;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(coefficients_.rows());
  for (Eigen::Index k = 0; k < choice.pull.size(); ++k) {
    forces += choice.pull[k] * coefficients_.col(choice.independent[k]);
  }
  Eigen::VectorXcd position = choice.scale * start_ + system_->expand(factor_->solve(forces));
  const bool is_mended = minimize(position);
  if (is_mended) snap(step_of_lines, position);
  if (is_mended && is_valid(position) && is_on_lattice(position)) return position;
  if (keeps_corners_) return std::nullopt;
  Array<Index> defects = defects_of(position);
  if (!are_few(defects)) hopeless_scale_ = choice.scale;
  const bool has_fewer = lattice_defects_.empty() || defects.size() <= lattice_defects_.size();
  if (!defects.empty() && has_fewer) lattice_defects_ = std::move(defects);
  return std::nullopt;
}

// Whether cones and translations are.
bool FeatureLayout::is_on_lattice(const Eigen::VectorXcd& position) const {
  for (std::ptrdiff_t i = length_count_; i < lattice_count_; ++i) {
    const double value = value_of(rounded_[i], position);
    if (!(std::abs(value - std::round(value)) <= whole)) return false;
  }
  return true;
}

// Removes what rounding errors leave of the deviations of lines.
void FeatureLayout::snap(double step, Eigen::VectorXcd& position) const {
  if (may_shift_) {
    Complex shift = 0;
    for (const Index axis : {1, 0}) {
      const auto first = std::find_if(lines_.begin(), lines_.end(),
                                      [&](const Array<Index>& line) { return line.front() % 2 == axis; });
      if (first == lines_.end()) continue;
      const double at = coordinate_at(first->front(), position), off = std::round(at) - at;
      shift += axis == 0 ? Complex(off, 0) : Complex(0, off);
    }
    position.array() += shift;
  }
  for (const Array<Index>& line : lines_) {
    const double at = step * std::round(coordinate_at(line.front(), position) / step);
    for (const Index of : line) set_coordinate(of, at, position);
  }
}

bool FeatureLayout::is_upright(Index triangle, const Eigen::VectorXcd& position) const {
  const auto corner = [&](int c) { return position[task_.surface.cut_mesh.copy_of_corner[3 * triangle + c]]; };
  return std::imag(std::conj(corner(1) - corner(0)) * (corner(2) - corner(0))) > 0;
}

// A few triangles do not count.
bool FeatureLayout::flips_at_most(double share, const Eigen::VectorXcd& position) const {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  Index flipped = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) flipped += is_upright(f, position) ? 0 : 1;
  return flipped <= few || flipped <= share * mesh.triangle_count();
}

// Removes flips and relaxes stretch under the conditions, unless too much is flipped; whether the map is valid then.
bool FeatureLayout::minimize(Eigen::VectorXcd& position) const {
  if (!flips_at_most(mendable_share, position)) return false;
  relax(Eigen::VectorXd::Ones(task_.surface.mesh.triangle_count()), position);
  return is_valid(position);
}

void FeatureLayout::relax(const Eigen::VectorXd& weights, Eigen::VectorXcd& position) const {
  const Eigen::VectorXd frames = Eigen::VectorXd::Zero(weights.size());
  const Eigen::VectorXd rest = scale_at_rest(task_.surface, task_.curvature, 1, position);
  NewtonMinimizer newton(task_.surface, {rest, frames}, keeps_corners_ ? held_corners_ : held_, task_.before_step,
                         position);
  newton.weigh(weights);
  // Wrong angle sums stay wrong without flips.
  if (newton.unfold(Kind::foldover_free, unfolding_steps) && is_valid(position)) {
    newton.smooth(Kind::symmetric_dirichlet, relaxing_steps, least_decrease);
  }
}

Validity FeatureLayout::validity_of(const Eigen::VectorXcd& position) const {
  const CutSurface& surface = task_.surface;
  return check_map(surface.mesh, at_corners(surface.cut_mesh, position), task_.curvature.at_vertex,
                   task_.curvature.is_free);
}

bool FeatureLayout::is_valid(const Eigen::VectorXcd& position) const { return validity_of(position).defects() == 0; }

}  // namespace lsgp
