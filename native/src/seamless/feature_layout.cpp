// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_layout.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "lsgp/errors.hpp"
#include "repair/low_stretch.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr int most_attempts = 24;             // to align lines
constexpr Index attempted_triangles = 80000;  // in all attempts together; the first is always made
constexpr int most_fits = 300;                // to find lines that contradict each other
constexpr Index fitted_triangles = 400000;    // in all of them together
constexpr double least_length = 0.1;          // of an edge, relative to the map without lines, that contradicts none
constexpr double mendable_share = 0.1;        // of the triangles, flipped, that are repaired
constexpr int most_trimmings = 3;             // of lines that fail at a few places
constexpr std::ptrdiff_t most_defects = 48;   // vertices there
constexpr double compatible_share = 0.01;     // that lines may flip which contradict none
constexpr Index few = 8;                      // that are always
constexpr int unfolding_steps = 8;
constexpr int relaxing_steps = 30;
constexpr double least_decrease = 1e-3;           // of the energy, for which a further step is taken
constexpr double fine_step = 1.0 / 256;           // exact in single precision on any grid
constexpr double short_length = 1.5;              // cells: lines that are rounded first
constexpr double whole = 1e-5;                    // deviation of a dependent coordinate from its step
constexpr int tried_scales = 3;                   // above and below the one asked for, by sixteenths of an octave
constexpr std::ptrdiff_t many_coordinates = 128;  // for which only one scale is tried

CoordinateForm coordinate(Index of) { return {{of / 2, of % 2 == 0 ? Complex(0, 1) : Complex(1)}}; }

double coordinate_at(Index of, const Eigen::VectorXcd& position) {
  return of % 2 == 0 ? position[of / 2].real() : position[of / 2].imag();
}

void set_coordinate(Index of, double value, Eigen::VectorXcd& position) {
  Complex& at = position[of / 2];
  at = of % 2 == 0 ? Complex(value, at.imag()) : Complex(at.real(), value);
}

}  // namespace

FeatureLayout::FeatureLayout(const FeatureTask& task, const PerHalfedge<char>& feature, const Eigen::VectorXcd& start,
                             double most_l2)
    : task_(task),
      unaligned_(start),
      most_l2_(most_l2),
      reasons_(task.surface.mesh.halfedge_count(), ReleaseReason::contradiction) {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  left_ = std::clamp(attempted_triangles / mesh.triangle_count(), 1, most_attempts);
  fits_left_ = std::clamp(fitted_triangles / mesh.triangle_count(), 1, most_fits);
  is_cone_.assign(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    is_cone_[v] = mesh.loop_of_vertex[v] == none && task_.curvature.at_vertex[v] != 0;
  }
  // Close to an isometry, lines have nearly their final directions.
  held_ = free_all(mesh, task_.surface.cut_mesh, task_.lattice.reduction, PerVertex<char>(mesh.vertex_count(), 0));
  minimize(unaligned_);
  unaligned_ *= turn_to_features(task_.surface, feature, unaligned_);
  const FeatureLines traced = trace_features(task_.surface, feature, is_cone_, unaligned_);
  for (const Index h : traced.curved) reasons_[h] = ReleaseReason::curved;
  jacobians_ = measure_jacobians(task_.surface, task_.surface.cut_mesh, unaligned_);
  Array<FeatureLine> lines;
  choose_compatible(traced.straight, 0, ssize(traced.straight), lines);
  const std::ptrdiff_t marked =
      std::count_if(lines.begin(), lines.end(), [](const FeatureLine& line) { return line.is_marked; });
  if (marked > 0) add(lines, 0, marked);
  add(lines, marked, ssize(lines));
  if (!aligned_.empty()) find_coordinates();
}

// Appends those that do not contradict each other, giving precedence to the first: halves with contradictions are
// divided again. A linear fit decides, which takes a small part of the time of a map.
void FeatureLayout::choose_compatible(const Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end,
                                      Array<FeatureLine>& chosen) {
  if (begin == end || fits_left_ == 0) return;
  --fits_left_;
  Array<FeatureLine> more = chosen;
  more.insert(more.end(), lines.begin() + begin, lines.begin() + end);
  const std::optional<Eigen::VectorXcd> position =
      fit(free_along(task_.surface, task_.lattice.reduction, edges_of(more)));
  if (position && keeps_lengths(more, *position) && flips_at_most(compatible_share, *position)) {
    chosen = std::move(more);
  } else if (end - begin > 1) {
    const std::ptrdiff_t middle = begin + (end - begin) / 2;
    choose_compatible(lines, begin, middle, chosen);
    choose_compatible(lines, middle, end, chosen);
  }
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

// Whether no edge of a line has collapsed or been reversed.
bool FeatureLayout::keeps_lengths(const Array<FeatureLine>& lines, const Eigen::VectorXcd& position) const {
  const CutMesh& cut_mesh = task_.surface.cut_mesh;
  for (const FeatureLine& line : lines) {
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index tail = cut_mesh.copy_of_corner[line.halfedges[i]];
      const Index head = cut_mesh.copy_of_corner[next(line.halfedges[i])];
      const double along = std::real(std::conj(line.directions[i]) * (position[head] - position[tail]));
      if (!(along > least_length * std::abs(unaligned_[head] - unaligned_[tail]))) return false;
    }
  }
  return true;
}

// All of them, or else as many as possible: lines that fail at a few places are released there, and otherwise halves
// that fail are divided again.
void FeatureLayout::add(Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end) {
  std::optional<ReleaseReason> reason = ReleaseReason::contradiction;
  for (int trimmings = 0; reason; ++trimmings) {
    if (begin == end || left_ == 0) return;
    Array<Index> defects;
    reason = align(lines, begin, end, defects);
    if (trimmings == most_trimmings || !trim(defects, lines, begin, end)) break;
  }
  if (!reason) return;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    for (const Index h : lines[i].halfedges) reasons_[h] = *reason;
  }
  if (end - begin == 1) return;
  const std::ptrdiff_t middle = begin + (end - begin) / 2;
  add(lines, begin, middle);
  add(lines, middle, end);
}

// Releases the edges of lines at some vertices; whether there are any, and others left. No distance between cones
// follows from what is left of a line.
bool FeatureLayout::trim(const Array<Index>& vertices, Array<FeatureLine>& lines, std::ptrdiff_t begin,
                         std::ptrdiff_t end) {
  if (vertices.empty() || ssize(vertices) > most_defects) return false;
  const HalfedgeMesh& mesh = task_.surface.mesh;
  const auto is_listed = [&](Index v) { return std::find(vertices.begin(), vertices.end(), v) != vertices.end(); };
  bool is_trimmed = false, has_others = false;
  for (std::ptrdiff_t k = begin; k < end; ++k) {
    FeatureLine kept = lines[k];
    kept.halfedges.clear();
    kept.directions.clear();
    for (Index i = 0; i < ssize(lines[k].halfedges); ++i) {
      const Index h = lines[k].halfedges[i];
      if (is_listed(mesh.origin(h)) || is_listed(mesh.target(h))) continue;
      kept.halfedges.push_back(h);
      kept.directions.push_back(lines[k].directions[i]);
    }
    has_others = has_others || !kept.halfedges.empty();
    if (kept.halfedges.size() == lines[k].halfedges.size()) continue;
    is_trimmed = true;
    kept.is_whole = false;
    lines[k] = std::move(kept);
  }
  return is_trimmed && has_others;
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
  aligned_ = std::move(more);
  start_ = std::move(*position);
  return std::nullopt;
}

// The vertices of flipped triangles, and those with wrong angle sums.
Array<Index> FeatureLayout::defects_of(const Eigen::VectorXcd& position) const {
  const Validity validity = validity_of(position);
  Array<Index> out = validity.wrong_angle_sums;
  for (const Index f : validity.flipped) {
    for (int c = 0; c < 3; ++c) out.push_back(task_.surface.mesh.triangles(f, c));
  }
  return out;
}

bool FeatureLayout::loosen() {
  const std::size_t kept = 5 * aligned_.size() / 6;
  if (kept == 0) return false;
  Array<FeatureLine> released(aligned_.begin() + static_cast<std::ptrdiff_t>(kept), aligned_.end());
  aligned_.resize(kept);
  held_ = free_along(task_.surface, task_.lattice.reduction, edges_of(aligned_));
  std::optional<Eigen::VectorXcd> position = fit(held_);
  if (!position || !minimize(*position)) return false;
  start_ = std::move(*position);
  for (const FeatureLine& line : released) {
    for (const Index h : line.halfedges) reasons_[h] = ReleaseReason::lattice;
  }
  lines_.clear();
  rounded_.clear();
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
  Array<Index> reference(2, none);
  for (const Array<Index>& line : lines_) {
    CoordinateForm form = coordinate(line.front());
    Index& first = reference[line.front() % 2];
    if (may_shift_ && first == none) first = line.front();
    if (may_shift_ && first != line.front()) form.emplace_back(first / 2, -form.front().second);
    if (may_shift_ && first == line.front()) continue;
    rounded_.push_back(std::move(form));
  }
  const Reduction& reduction = task_.lattice.reduction;
  system_.emplace(task_.surface, free_along(task_.surface, reduction, edges));
  factor_.emplace(system_->dirichlet().triangularView<Eigen::Lower>());
  coefficients_.resize(system_->dirichlet().rows(), ssize(rounded_));
  for (std::ptrdiff_t i = 0; i < ssize(rounded_); ++i) coefficients_.col(i) = system_->coefficients_of(rounded_[i]);
  compliance_.resize(ssize(rounded_), ssize(rounded_));
  constexpr Eigen::Index at_once = 16;
  for (Eigen::Index i = 0; i < compliance_.cols(); i += at_once) {
    const Eigen::Index width = std::min(at_once, compliance_.cols() - i);
    const Eigen::MatrixXd forces = coefficients_.middleCols(i, width);
    compliance_.middleCols(i, width) = coefficients_.transpose() * factor_->solve(forces);
  }
  whole_values_ = WholeValues::among(compliance_);
  Eigen::VectorXd units = Eigen::VectorXd::Ones(ssize(rounded_));
  units.tail(ssize(rounded_) - lattice_count_).setConstant(1 / fine_step);
  fine_values_ = WholeValues::among(units.asDiagonal() * compliance_ * units.asDiagonal());
  DirectedEdges fixed = edges;
  fixed.fixed = rounded_;
  held_ = free_along(task_.surface, reduction, fixed);
}

// Rounds one coordinate after the other, the cheapest first; the others follow.
std::optional<FeatureLayout::Choice> FeatureLayout::round(double scale, bool is_fine) const {
  const std::optional<WholeValues>& all = is_fine ? fine_values_ : whole_values_;
  if (!all) return std::nullopt;
  WholeValues values = *all;
  const std::ptrdiff_t count = ssize(rounded_);
  Choice out{scale, {}, {}, {}, 0};
  Eigen::VectorXd value(count);
  for (std::ptrdiff_t i = 0; i < count; ++i) value[i] = scale * value_of(rounded_[i], start_);
  PivotedCholesky cholesky(compliance_);
  Array<char> is_done(count, 0);
  const auto unit = [&](std::ptrdiff_t i) { return is_fine && i >= lattice_count_ ? fine_step : 1.0; };
  const auto least = [&](std::ptrdiff_t i) {
    return i < length_count_ ? 1.0 : -std::numeric_limits<double>::infinity();
  };
  const auto off = [&](std::ptrdiff_t i) {
    return std::max(unit(i) * std::round(value[i] / unit(i)), least(i)) - value[i];
  };
  // Lines between cones keep a length; where lines need not be on the lattice, they wait for it.
  for (const std::ptrdiff_t end : {length_count_, is_fine ? lattice_count_ : count, count}) {
    for (;;) {
      checkpoint(static_cast<double>(count * (ssize(out.independent) + 1)));
      std::ptrdiff_t best = -1;
      double cheapest = std::numeric_limits<double>::infinity();
      for (std::ptrdiff_t i = 0; i < end; ++i) {
        if (is_done[i] || !cholesky.is_independent(i)) continue;
        if (end == length_count_ && value[i] > short_length) continue;
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

std::optional<Eigen::VectorXcd> FeatureLayout::quantize(double density) const {
  const std::optional<Choice> whole_lines = choose(density, false);
  if (whole_lines) {
    if (auto out = lay_out(*whole_lines, 1)) return out;
  }
  const std::optional<Choice> fine_lines = choose(density, true);
  if (!fine_lines) return std::nullopt;
  // The same values would fail in the same way.
  if (whole_lines && whole_lines->scale == fine_lines->scale &&
      (whole_lines->values - fine_lines->values).isZero(whole)) {
    return std::nullopt;
  }
  return lay_out(*fine_lines, fine_step);
}

// The cheapest one of some scales about this one.
std::optional<FeatureLayout::Choice> FeatureLayout::choose(double density, bool is_fine) const {
  std::optional<Choice> best;
  double least = std::numeric_limits<double>::infinity();
  const int scales = ssize(rounded_) > many_coordinates ? 0 : tried_scales;
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

std::optional<Eigen::VectorXcd> FeatureLayout::lay_out(const Choice& choice, double step_of_lines) const {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(coefficients_.rows());
  for (Eigen::Index k = 0; k < choice.pull.size(); ++k) {
    forces += choice.pull[k] * coefficients_.col(choice.independent[k]);
  }
  Eigen::VectorXcd position = choice.scale * start_ + system_->expand(factor_->solve(forces));
  if (!minimize(position)) return std::nullopt;
  snap(step_of_lines, position);
  if (!is_valid(position) || !is_on_lattice(position)) return std::nullopt;
  return position;
}

// Whether cones and translations are. Where all cuts go around holes, shifts change all translations and cost nothing:
// the compliance is unbounded then, and which coordinates follow from others is lost to rounding errors.
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

// A few triangles do not count.
bool FeatureLayout::flips_at_most(double share, const Eigen::VectorXcd& position) const {
  const HalfedgeMesh& mesh = task_.surface.mesh;
  Index flipped = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const auto corner = [&](int c) { return position[task_.surface.cut_mesh.copy_of_corner[3 * f + c]]; };
    if (!(std::imag(std::conj(corner(1) - corner(0)) * (corner(2) - corner(0))) > 0)) ++flipped;
  }
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
  NewtonMinimizer newton(task_.surface, {rest, frames}, held_, task_.before_step, position);
  newton.weigh(weights);
  if (newton.unfold(Kind::foldover_free, unfolding_steps)) {
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
