// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_layout.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "creases/features.hpp"
#include "seamless/aligned_lines.hpp"

namespace lsgp {

namespace {

constexpr int most_trimmings = 4;                 // of lines whose layout on the lattice fails at a few places
constexpr double least_kept = 0.25;               // of their length on a lattice
constexpr double most_cost = 0.25;                // of rounding, relative to the area: beyond, layouts fold or stretch
constexpr double most_cost_of_corners = 0.05;     // besides
constexpr double fine_step = 1.0 / 256;           // exact in single precision on any grid
constexpr double short_length = 1.5;              // cells: what is rounded first
constexpr std::ptrdiff_t most_distances = 256;    // between lines, the least ones
constexpr double least_slope = 0.6;               // sine of the angle to lines of an edge that keeps them apart
constexpr double least_response = 1e-9;           // of a coordinate to a shift, or to unknowns
constexpr double whole = 1e-5;                    // deviation of a dependent coordinate from its step
constexpr int tried_scales = 3;                   // above and below the one asked for, by sixteenths of an octave
constexpr std::ptrdiff_t many_coordinates = 512;  // for which only one scale is tried

// Multiplications in choosing values for one map: some ten seconds. A hundred coordinates take a hundredth of that.
// It is also the limit for the cube of their number, by which the work of finding what depends on what grows.
constexpr double most_work = 1e10;

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

}  // namespace

FeatureLayout::FeatureLayout(const FeatureTask& task, const FeatureAlignment& alignment, double coarse_step)
    : task_(task),
      is_cone_(task.mark_cones()),
      reasons_(alignment.reasons),
      aligned_(alignment.lines),
      aligned_length_(total_length(aligned_)),
      coarse_step_(coarse_step),
      start_(alignment.start),
      left_(most_work) {
  find_coordinates();
  is_large_ = has_many_coordinates();
}

// Single edges are released a few times, and independently of that whole lines.
void FeatureLayout::find_loosened() {
  const Array<Index> defects = std::exchange(lattice_defects_, {});
  const int trimmings = trimmings_;
  Loosened trimmed{aligned_, start_, trimmings + 1};
  if (trimmings >= 0 && trimmings < most_trimmings && trim(task_.surface, {defects}, trimmed.lines, nullptr)) {
    loosened_.push_back(std::move(trimmed));
  }
  if (trimmings > 0) return;
  Loosened shortened{aligned_, start_, -1};
  Array<FeatureLine>& lines = shortened.lines;
  // Layouts that keep less are not worth their time.
  const auto is_enough = [&] { return total_length(lines) > least_kept * aligned_length_; };
  lines.erase(std::remove_if(lines.begin(), lines.end(), [](const FeatureLine& line) { return line.comes_last; }),
              lines.end());
  if (lines.size() == aligned_.size() || !is_enough()) {
    lines = aligned_;
    lines.resize(5 * lines.size() / 6);
  }
  if (is_enough()) loosened_.push_back(std::move(shortened));
}

bool FeatureLayout::loosen() {
  if (left_ <= 0) return false;
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
    held_ = free_along(task_.surface, task_.reduction, edges_of(aligned_));
    // It fulfills the conditions that are left, and stays valid.
    task_.relax(held_, Eigen::VectorXd::Ones(task_.surface.mesh.triangle_count()), start_);
  } while (!task_.is_valid(start_));
  if (trimmings_ < 0) hopeless_scale_ = 0;
  PerHalfedge<char> is_kept(task_.surface.mesh.halfedge_count(), 0);
  for (const Index h : edges_of(aligned_).halfedges) is_kept[h] = 1;
  for (const FeatureLine& line : before) {
    for (const Index h : line.halfedges) {
      if (!is_kept[h]) release(h, ReleaseReason::lattice, reasons_);
    }
  }
  lines_.clear();
  rounded_.clear();
  held_translation_.clear();
  find_coordinates();
  return true;
}

// What the lattice rounds, as coordinates of the copies.
void FeatureLayout::find_lattice_coordinates() {
  const auto& [surface, curvature, rotation, lattice, reduction, before_step] = task_;
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
  if (std::pow(static_cast<double>(ssize(rounded_)), 3) > most_work) left_ = 0;
  if (left_ <= 0) return;
  const Reduction& reduction = task_.reduction;
  DirectedEdges fixed = edges;
  fixed.fixed = held_translation_;
  system_.emplace(task_.surface, free_along(task_.surface, reduction, fixed));
  factor_.emplace(system_->dirichlet().triangularView<Eigen::Lower>());
  coefficients_ = system_->coefficients_of(rounded_);
  for (Eigen::Index i = 0; i < coefficients_.cols(); ++i) {
    if (Eigen::VectorXd(coefficients_.col(i)).cwiseAbs().maxCoeff() < least_response)
      coefficients_.col(i) *= 0;  // held
  }
  coefficients_.prune(0.0);
  compliance_.resize(ssize(rounded_), ssize(rounded_));
  constexpr Eigen::Index at_once = 16;
  for (Eigen::Index i = 0; i < compliance_.cols(); i += at_once) {
    const Eigen::Index width = std::min(at_once, compliance_.cols() - i);
    const Eigen::MatrixXd forces(coefficients_.middleCols(i, width));
    compliance_.middleCols(i, width) = coefficients_.transpose() * factor_->solve(forces);
  }
  coarse_values_ = find_values(coarse_step_);
  are_fine_values_known_ = false;
  fixed.fixed = rounded_;
  held_corners_ = free_along(task_.surface, reduction, fixed);
  fixed.fixed.resize(line_count_);
  held_ = free_along(task_.surface, reduction, fixed);
}

// The values of what the lattice rounds in cells, and of lines and distances in these steps.
std::optional<WholeValues> FeatureLayout::find_values(double step) const {
  Eigen::VectorXd units = Eigen::VectorXd::Ones(line_count_);
  units.tail(line_count_ - lattice_count_).setConstant(1 / step);
  const auto of_lines = compliance_.topLeftCorner(line_count_, line_count_);
  return WholeValues::among(units.asDiagonal() * of_lines * units.asDiagonal());
}

double FeatureLayout::step_of(Rounding rounding) const { return rounding == Rounding::fine ? fine_step : coarse_step_; }

// Rounds one coordinate after the other, the cheapest first; the others follow.
std::optional<FeatureLayout::Choice> FeatureLayout::round(double scale, Rounding rounding, double too_much) {
  if (left_ <= 0) return std::nullopt;
  const bool is_fine = rounding == Rounding::fine;
  const std::optional<WholeValues>& all = is_fine ? fine_values_ : coarse_values_;
  if (!all) return std::nullopt;
  WholeValues values = *all;
  const std::ptrdiff_t count = line_count_;
  Choice out{rounding, scale, {}, {}, {}, 0};
  Eigen::VectorXd value(ssize(rounded_));
  for (std::ptrdiff_t i = 0; i < value.size(); ++i) value[i] = scale * value_of(rounded_[i], start_);
  PivotedCholesky cholesky(compliance_);
  Array<char> is_done(count, 0);
  const auto unit = [&](std::ptrdiff_t i) { return i >= lattice_count_ ? step_of(rounding) : 1.0; };
  const auto may_vanish = [&](std::ptrdiff_t i) {
    return i < length_count_ || (i >= lattice_count_ && i < distance_count_);
  };
  const auto least = [&](std::ptrdiff_t i) {
    return may_vanish(i) ? unit(i) : -std::numeric_limits<double>::infinity();
  };
  const auto off = [&](std::ptrdiff_t i) {
    return std::max(unit(i) * std::round(value[i] / unit(i)), least(i)) - value[i];
  };
  // Whichever is chosen in the end; distances may vanish where they follow from others.
  const auto least_off = [&](std::ptrdiff_t i) {
    return i < lattice_count_ ? off(i) : unit(i) * std::round(value[i] / unit(i)) - value[i];
  };
  // Short lengths and distances come first, so that they do not vanish; where lines need not be on the lattice, they
  // wait for it.
  enum class Stage { vanishing, on_lattice, all };
  for (const Stage stage : {Stage::vanishing, Stage::on_lattice, Stage::all}) {
    const std::ptrdiff_t end = is_fine && stage != Stage::all ? lattice_count_ : count;
    for (;;) {
      const auto operations = static_cast<double>(ssize(rounded_) * (ssize(out.independent) + 1));
      left_ -= operations;
      checkpoint(operations);
      std::ptrdiff_t best = -1;
      double cheapest = std::numeric_limits<double>::infinity();
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        if (is_done[i] || !cholesky.is_independent(i)) continue;
        if (out.cost + least_off(i) * least_off(i) / cholesky.left()[i] >= too_much) return std::nullopt;
        if (i >= end) continue;
        if (stage == Stage::vanishing && !(may_vanish(i) && value[i] <= short_length)) continue;
        const double cost = off(i) * off(i) / cholesky.left()[i];
        if (!(cost < cheapest)) continue;
        cheapest = cost;
        best = i;
      }
      if (best < 0) break;
      is_done[best] = 1;
      const double step = values.isolate(best);
      const double to = values.nearest(best, step, value[best] / unit(best), least(best) / unit(best));
      if (!values.fix(best, step, to)) return std::nullopt;
      const double by = unit(best) * to - value[best];
      const Eigen::VectorXd column = cholesky.column(best);
      value += column * (by / column[best]);
      out.cost += by * by / column[best];
      if (out.cost >= too_much) return std::nullopt;
      cholesky.eliminate(best, column);
      out.independent.push_back(static_cast<Index>(best));
    }
  }
  for (std::ptrdiff_t i = 0; i < length_count_; ++i) {
    if (value[i] < 1 - whole) return std::nullopt;
  }
  if (rounding == Rounding::with_corners) round_corners(value, cholesky, out);
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
  const auto off = [&](std::ptrdiff_t i) { return coarse_step_ * std::round(value[i] / coarse_step_) - value[i]; };
  double left = most_cost_of_corners * choice.scale * choice.scale * task_.surface.geometry.total_area;
  for (;;) {
    checkpoint(static_cast<double>(value.size() * (ssize(choice.independent) + 1)));
    std::ptrdiff_t best = -1;
    double cheapest = left;
    for (std::ptrdiff_t i = line_count_; i < value.size(); ++i) {
      if (!cholesky.is_independent(i)) continue;
      const double cost = off(i) * off(i) / cholesky.left()[i];
      if (!(cost < cheapest)) continue;
      cheapest = cost;
      best = i;
    }
    if (best < 0) return;
    left -= cheapest;
    const Eigen::VectorXd column = cholesky.column(best);
    value += column * (off(best) / column[best]);
    cholesky.eliminate(best, column);
    choice.independent.push_back(static_cast<Index>(best));
  }
}

std::optional<Eigen::VectorXcd> FeatureLayout::quantize(double density, bool must_be_coarse, bool keeps_corners,
                                                        const std::function<bool(const Eigen::VectorXcd&)>& accepts) {
  if (left_ <= 0) return std::nullopt;
  const std::optional<Choice> coarse_lines = choose(density, keeps_corners ? Rounding::with_corners : Rounding::coarse);
  const auto is_of_corner = [&](Index i) { return i >= line_count_; };
  if (keeps_corners && coarse_lines &&
      std::none_of(coarse_lines->independent.begin(), coarse_lines->independent.end(), is_of_corner)) {
    return std::nullopt;
  }
  if (coarse_lines) {
    auto out = lay_out(*coarse_lines);
    if (out && accepts(*out)) return out;
  }
  if (must_be_coarse) return std::nullopt;
  // Only such layouts take them.
  if (!std::exchange(are_fine_values_known_, true)) fine_values_ = find_values(fine_step);
  const std::optional<Choice> fine_lines = choose(density, Rounding::fine);
  if (!fine_lines) return std::nullopt;
  // The same values would fail in the same way.
  if (coarse_lines && coarse_lines->scale == fine_lines->scale &&
      (coarse_lines->values - fine_lines->values).isZero(whole)) {
    return std::nullopt;
  }
  auto out = lay_out(*fine_lines);
  return out && accepts(*out) ? out : std::nullopt;
}

bool FeatureLayout::has_many_coordinates() const {
  return line_count_ - (distance_count_ - lattice_count_) > many_coordinates;
}

// The cheapest one of some scales about this one.
std::optional<FeatureLayout::Choice> FeatureLayout::choose(double density, Rounding rounding) {
  const int scales = has_many_coordinates() ? 0 : tried_scales;
  const auto growth_at = [](int k) { return k * M_LN2 / 16; };
  const auto cost_of_growth = [&](int k) {
    return 2 * task_.surface.geometry.total_area * growth_at(k) * growth_at(k);
  };
  if (density * std::exp(growth_at(scales)) <= hopeless_scale_) return std::nullopt;
  std::optional<Choice> best;
  // The layout would be refused if the cheapest cost more.
  double least = most_cost * task_.surface.geometry.total_area + 2 * cost_of_growth(scales);
  for (int k = -scales; k <= scales; ++k) {
    const double scale = density * std::exp(growth_at(k));
    std::optional<Choice> choice = round(scale, rounding, scale * scale * (least - cost_of_growth(k)));
    if (!choice) continue;
    const double cost = choice->cost / (choice->scale * choice->scale) + cost_of_growth(k);
    if (!(cost < least)) continue;
    least = cost;
    best = std::move(choice);
  }
  return best;
}

std::optional<Eigen::VectorXcd> FeatureLayout::lay_out(const Choice& choice) {
  const bool is_expensive = choice.cost > most_cost * choice.scale * choice.scale * task_.surface.geometry.total_area;
  if (is_expensive || choice.scale <= hopeless_scale_) return std::nullopt;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(coefficients_.rows());
  for (Eigen::Index k = 0; k < choice.pull.size(); ++k) {
    forces += choice.pull[k] * coefficients_.col(choice.independent[k]);
  }
  Eigen::VectorXcd position = choice.scale * start_ + system_->expand(factor_->solve(forces));
  const bool keeps_corners = choice.rounding == Rounding::with_corners;
  const bool is_mended = task_.minimize(held(keeps_corners), position);
  if (is_mended) snap(step_of(choice.rounding), position);
  if (is_mended && task_.is_valid(position) && is_on_lattice(position)) return position;
  if (keeps_corners) return std::nullopt;
  Array<Index> defects = task_.defects_of(position);
  if (!are_few(defects, task_.surface.mesh)) hopeless_scale_ = choice.scale;
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

}  // namespace lsgp
