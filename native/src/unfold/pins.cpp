// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/pins.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "solvers/saddle_point.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

constexpr double same_place = 1e-6;  // of the largest coordinate; texture coordinates come in single precision
constexpr double met = 1e-9;         // of the pins' extent
constexpr double one_point = 1e-60;  // pins closer together leave areas that vanish in double precision
constexpr double mirrored = 0.01;    // a fit that shrinks the pinned points below this share of their extent

double extent(const Array<Pin>& pins) {
  double out = 0;
  for (const Pin& pin : pins) out = std::max(out, std::abs(pin.position - pins.front().position));
  return out;
}

// The similarity z -> factor z + shift that fits the pins best.
struct Similarity {
  Complex factor, shift;
};

Similarity fit(const Array<Pin>& pins, const Eigen::VectorXcd& position) {
  const double count = static_cast<double>(pins.size());
  Complex from = 0, to = 0, along = 0;
  for (const Pin& pin : pins) {
    from += position[pin.copy] / count;
    to += pin.position / count;
  }
  double size = 0;
  for (const Pin& pin : pins) {
    const Complex off = position[pin.copy] - from;
    along += std::conj(off) * (pin.position - to);
    size += std::norm(off);
  }
  const Complex factor = size > 0 ? along / size : Complex(0, 0);
  return {factor, to - factor * from};
}

double largest_miss(const Array<Pin>& pins, const Eigen::VectorXcd& position) {
  double out = 0;
  for (const Pin& pin : pins) out = std::max(out, std::abs(position[pin.copy] - pin.position));
  return out;
}

[[noreturn]] void throw_conflict(const CutMesh& cut_mesh, const Array<Pin>& pins, const std::string& why) {
  Array<Index> vertices;
  for (const Pin& pin : pins) vertices.push_back(cut_mesh.source[pin.copy]);
  sort_unique(vertices);
  throw Error(Code::pins_conflict, why, {ElementKind::vertices, std::move(vertices)});
}

}  // namespace

Array<Pin> pins_of_copies(const CutMesh& cut_mesh, const Array<std::pair<Index, Complex>>& pinned_corners) {
  std::map<Index, Complex> place;
  double largest = 0;
  for (const auto& [corner, position] : pinned_corners) largest = std::max(largest, std::abs(position));
  for (const auto& [corner, position] : pinned_corners) {
    const Index copy = cut_mesh.copy_of_corner[corner];
    const auto [known, added] = place.emplace(copy, position);
    if (!added && std::abs(known->second - position) > same_place * largest) {
      throw_conflict(cut_mesh, {{copy, position}},
                     "A vertex is pinned to two places at once, but no cut runs there. Unpin one of its corners, or "
                     "mark a seam through it.");
    }
  }
  Array<Pin> pins;
  for (const auto& [copy, position] : place) pins.push_back({copy, position});
  return pins;
}

PinnedMap move_onto_pins(const CutSurface& surface, const Reduction& reduction, const Array<Pin>& pins,
                         bool similarity_only, const Eigen::VectorXcd& position) {
  const CutMesh& cut_mesh = surface.cut_mesh;
  const double size = extent(pins);
  const Similarity similarity = fit(pins, position);
  if (!(size > one_point)) {
    throw_conflict(cut_mesh, pins,
                   "All pinned corners coincide, which leaves no size for the layout. Spread "
                   "the pins or unpin all but one.");
  }
  double fitted = 0;
  for (const Pin& pin : pins)
    fitted = std::max(fitted, std::abs(similarity.factor * (position[pin.copy] - position[pins.front().copy])));
  if (!(fitted > mirrored * size)) {
    throw_conflict(cut_mesh, pins,
                   "The pins reflect or fold the surface, so that no rotation and size fit them. Mirror them back or "
                   "unpin all but two.");
  }
  PinnedMap out{similarity.factor * position, std::abs(similarity.factor)};
  out.position.array() += similarity.shift;
  if (!(largest_miss(pins, out.position) > met * size)) return out;
  if (similarity_only) {
    throw_conflict(
        cut_mesh, pins,
        "With corners and straight boundaries pins only determine the layout's position, size and rotation, for which "
        "two suffice. Unpin all but two, or leave the boundary free.");
  }

  // Displacement d = B x + one constant. The constant is taken up by shifting the pins: the first becomes the origin.
  const Eigen::SparseMatrix<Complex> form = assemble_form(Form::dirichlet, surface, cut_mesh, reduction);
  Eigen::SparseMatrix<Complex, Eigen::RowMajor> rows(static_cast<Eigen::Index>(pins.size()) - 1,
                                                     reduction.unknown_count);
  Eigen::VectorXcd values(rows.rows());
  std::vector<Eigen::Triplet<Complex>> entries;
  const Complex origin = pins.front().position - out.position[pins.front().copy];
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Pin& pin = pins[i + 1];
    values[i] = pin.position - out.position[pin.copy] - origin;
    const auto add = [&](Index copy, double sign) {
      reduction.for_each_term(copy, [&](const Term& term) {
        entries.emplace_back(static_cast<int>(i), term.unknown, sign * term.coefficient);
      });
    };
    add(pin.copy, 1);
    add(pins.front().copy, -1);
  }
  rows.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXcd displacement =
      expand(reduction, minimize_under<Complex>(form, Eigen::VectorXcd::Zero(reduction.unknown_count), rows, values).x);
  out.position += displacement;
  out.position.array() += origin - displacement[pins.front().copy];
  const double miss = largest_miss(pins, out.position);
  if (!(miss <= met * size)) {
    throw_conflict(
        cut_mesh, pins,
        concat("The pins contradict the rotations across the cuts: ", count(pins.size(), "pin", "pins"),
               " cannot all be met, the worst is missed by ", rounded(miss, 3), ". Unpin vertices beside cuts."));
  }
  return out;
}

}  // namespace lsgp
