// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/rounding_repair.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/checkpoint.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

constexpr std::size_t most_visits = 24;  // of vertices, for each triangle that is flipped
constexpr int farthest_ring = 4;
constexpr double flatness_of_flipped = 2;
constexpr double least_gain = 1e-9;

// Volatile: GCC 12 removes two adjacent conversions to float and back.
double stored_number(double x) {
  const volatile float stored = static_cast<float>(x);
  return stored;
}

// The shortest first.
Array<Complex> moves_of(double step) {
  constexpr int farthest = 2, doublings = 6;
  Array<Complex> out;
  for (int k = 0; k < doublings; ++k) {
    for (int i = -farthest; i <= farthest; ++i) {
      for (int j = -farthest; j <= farthest; ++j) {
        // Others are among those of the last step.
        if (k > 0 && std::max(std::abs(i), std::abs(j)) < farthest) continue;
        if (i != 0 || j != 0) out.emplace_back(std::ldexp(i * step, k), std::ldexp(j * step, k));
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](Complex a, Complex b) { return std::norm(a) < std::norm(b); });
  return out;
}

}  // namespace

Complex as_stored(Complex z) { return {stored_number(z.real()), stored_number(z.imag())}; }

Array<Index> find_flipped(const CutMesh& cut_mesh, const Eigen::VectorXcd& position) {
  Array<Index> out;
  for (Index f = 0; f < ssize(cut_mesh.copy_of_corner) / 3; ++f) {
    const auto corner = [&](int c) { return position[cut_mesh.copy_of_corner[3 * f + c]]; };
    const auto stored = [&](int c) { return as_stored(corner(c)); };
    const bool is_upright = doubled_area(corner(0), corner(1), corner(2)) > 0;
    if (!is_upright || !(doubled_area(stored(0), stored(1), stored(2)) > 0)) out.push_back(f);
  }
  return out;
}

RoundingRepair::RoundingRepair(const HalfedgeMesh& mesh, const CutMesh& cut_mesh,
                               std::function<Array<MovingCopy>(Index)> copies, double step, Eigen::VectorXcd& position)
    : mesh_(mesh),
      cut_mesh_(cut_mesh),
      copies_(std::move(copies)),
      step_(step),
      moves_(moves_of(step)),
      position_(position) {}

Array<Index> RoundingRepair::repair(Array<Index> flipped, const PerHalfedge<char>& kept) {
  std::size_t visits = most_visits * flipped.size();
  int rings = 0;
  while (!flipped.empty() && rings <= farthest_ring) {
    const Array<Index> vertices = vertices_near(flipped, rings);
    bool has_changed = false;
    for (const Index v : vertices) {
      if (visits == 0) return flipped;
      --visits;
      has_changed = improve(v, kept) || has_changed;
    }
    const std::size_t before = flipped.size();
    flipped = triangles_around(vertices);
    flipped.erase(
        std::remove_if(flipped.begin(), flipped.end(), [&](Index f) { return flatness(f) < flatness_of_flipped; }),
        flipped.end());
    if (flipped.size() < before)
      rings = 0;
    else if (!has_changed)
      ++rings;
  }
  return flipped;
}

// Corners of these triangles, and of so many rings of flat triangles around them.
Array<Index> RoundingRepair::vertices_near(const Array<Index>& triangles, int rings) const {
  Array<Index> out = corners_of(triangles);
  for (int ring = 0; ring < rings; ++ring) {
    Array<Index> flat = triangles_around(out);
    flat.erase(std::remove_if(flat.begin(), flat.end(), [&](Index f) { return flatness(f) == 0; }), flat.end());
    out = corners_of(flat);
  }
  return out;
}

RoundingRepair::Star RoundingRepair::star_of(Index v) const {
  Star out{copies_(v), {}};
  if (out.copies.empty()) return out;
  mesh_.for_each_outgoing(v, [&](Index h) {
    const auto moving = std::find_if(out.copies.begin(), out.copies.end(),
                                     [&](const MovingCopy& copy) { return copy.copy == cut_mesh_.copy_of_corner[h]; });
    out.corners.push_back({h, moving->turn});
  });
  return out;
}

// What a triangle lacks of a height of one step, in steps, and 1 more without an area, as stored or before.
double RoundingRepair::flatness(Complex a, Complex b, Complex c) const {
  return std::max(exact_flatness(a, b, c), exact_flatness(as_stored(a), as_stored(b), as_stored(c)));
}

double RoundingRepair::exact_flatness(Complex a, Complex b, Complex c) const {
  const double area = doubled_area(a, b, c);
  const double longest = std::sqrt(std::max({std::norm(b - a), std::norm(c - b), std::norm(a - c)}));
  if (!(longest > 0)) return flatness_of_flipped;
  return std::max(0.0, 1 - area / (longest * step_)) + (area > 0 ? 0 : 1);
}

double RoundingRepair::flatness(Index f) const {
  const auto corner = [&](int c) { return position_[cut_mesh_.copy_of_corner[3 * f + c]]; };
  return flatness(corner(0), corner(1), corner(2));
}

double RoundingRepair::flatness(const Star& star, Complex move) const {
  double sum = 0;
  for (const Corner& corner : star.corners) {
    const auto at = [&](Index h) { return position_[cut_mesh_.copy_of_corner[h]]; };
    const Index h = corner.halfedge;
    sum += flatness(at(h) + corner.turn * move, at(next(h)), at(prev(h)));
  }
  return sum;
}

bool RoundingRepair::keeps_axes(const Star& star, const PerHalfedge<char>& kept, Complex move) const {
  return std::all_of(star.corners.begin(), star.corners.end(), [&](const Corner& corner) {
    const Index h = corner.halfedge;
    const auto at = [&](Index k) { return position_[cut_mesh_.copy_of_corner[k]]; };
    const Complex own = as_stored(at(h)), moved = as_stored(at(h) + corner.turn * move);
    const auto keeps = [&](Index edge, Index end) {
      const Complex other = as_stored(at(end));
      return !kept[edge] || !is_along_axis(own - other) || is_along_axis(moved - other);
    };
    return keeps(h, next(h)) && keeps(prev(h), prev(h));
  });
}

bool RoundingRepair::improve(Index v, const PerHalfedge<char>& kept) {
  constexpr double operations = 30;  // for a triangle
  const Star star = star_of(v);
  if (star.copies.empty()) return false;
  checkpoint(operations * static_cast<double>(star.corners.size() * moves_.size()));
  double least = flatness(star, 0);
  Complex best = 0;
  for (const Complex move : moves_) {
    if (!(least > least_gain)) break;
    if (!kept.empty() && !keeps_axes(star, kept, move)) continue;
    const double flat = flatness(star, move);
    if (!(flat < least - least_gain)) continue;
    least = flat;
    best = move;
  }
  if (best == 0.0) return false;
  for (const MovingCopy& copy : star.copies) position_[copy.copy] += copy.turn * best;
  // Several remain related exactly.
  if (star.copies.size() == 1) position_[star.copies[0].copy] = as_stored(position_[star.copies[0].copy]);
  return true;
}

Array<Index> RoundingRepair::triangles_around(const Array<Index>& vertices) const {
  Array<Index> out;
  for (const Index v : vertices) mesh_.for_each_outgoing(v, [&](Index h) { out.push_back(h / 3); });
  sort_unique(out);
  return out;
}

Array<Index> RoundingRepair::corners_of(const Array<Index>& triangles) const {
  Array<Index> out;
  for (const Index f : triangles) {
    for (int c = 0; c < 3; ++c) out.push_back(mesh_.triangles(f, c));
  }
  sort_unique(out);
  return out;
}

}  // namespace lsgp
