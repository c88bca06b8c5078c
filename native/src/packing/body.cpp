// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/body.hpp"

#include <algorithm>
#include <cmath>

#include "base/checkpoint.hpp"
#include "plane/convex_hull.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

// Of an edge along an axis, radians; coordinates may come from files of few digits.
constexpr double tilt = 1e-3;
// Of a pose's size: what differs by less is the same.
constexpr double same = 1e-6;

Complex unit(Complex z) { return z / std::sqrt(z.real() * z.real() + z.imag() * z.imag()); }

Complex quarter_turned(Complex z) { return {-z.imag(), z.real()}; }

// Unit vectors from one to another, `count`, a power of two, at equal angles; without the other. No trigonometric
// function, which libraries round differently.
void add_between(Complex begin, Complex end, int count, Array<Complex>& out) {
  if (count == 1) {
    out.push_back(begin);
    return;
  }
  const Complex middle = unit(begin + end);
  add_between(begin, middle, count / 2, out);
  add_between(middle, end, count / 2, out);
}

// The turn of a convex polygon, within a quarter, for which the square around it is smallest; looked for in steps that
// get finer.
Complex squarest_turn(const Array<Complex>& hull) {
  constexpr int steps = 64, refinements = 3;
  const auto side_at = [&](Complex turn) {
    const Extent extent = extent_along(hull, std::conj(turn));
    return std::max(extent.width(), extent.height());
  };
  Complex begin = 1, end = quarter_turned(1), best = 1;
  double least = side_at(best);
  for (int i = 0; i < refinements; ++i) {
    Array<Complex> turns;
    add_between(begin, end, steps, turns);
    turns.push_back(end);
    Array<double> sides;
    for (const Complex turn : turns) sides.push_back(side_at(turn));
    const std::ptrdiff_t found = std::min_element(sides.begin(), sides.end()) - sides.begin();
    if (sides[found] < least) {
      least = sides[found];
      best = turns[found];
    }
    begin = turns[std::max<std::ptrdiff_t>(found - 1, 0)];
    end = turns[std::min<std::ptrdiff_t>(found + 1, ssize(turns) - 1)];
  }
  return best;
}

bool is_same(const Pose& a, const Pose& b) {
  const double near = same * std::max(a.width, a.height);
  if (std::abs(a.width - b.width) > near || std::abs(a.height - b.height) > near) return false;
  // A turned outline has its points in another order.
  const auto sorted = [&](const Pose& pose) {
    Array<std::pair<double, double>> out;
    for (const Complex z : pose.outline.points())
      out.emplace_back(std::round(z.real() / near), std::round(z.imag() / near));
    std::sort(out.begin(), out.end());
    return out;
  };
  return sorted(a) == sorted(b);
}

}  // namespace

Array<Body> bodies_of(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options) {
  Index island_count = 0;
  for (const Index i : island) island_count = std::max(island_count, i + 1);
  Array<Index> body_of(island_count, -1);
  Array<Index> of_group;
  Array<Body> bodies;
  Array<Array<Complex>> corners(island_count);
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] < 0) continue;
    for (Index c = 0; c < 3; ++c) {
      const auto row = 3 * static_cast<Eigen::Index>(t) + c;
      corners[island[t]].emplace_back(corner_uv(row, 0) + 0.0, corner_uv(row, 1) + 0.0);  // -0.0 is 0.0
    }
  }
  for (Index i = 0; i < island_count; ++i) {
    if (corners[i].empty()) continue;
    const Index group = options.groups.empty() ? -1 : element(options.groups, i);
    if (group >= ssize(of_group)) of_group.resize(group + 1, -1);
    Index number = group < 0 ? -1 : of_group[group];
    if (number < 0) {
      number = static_cast<Index>(bodies.size());
      bodies.emplace_back();
      bodies.back().turns = options.turns;
      bodies.back().origin = corners[i][0];
      if (group >= 0) of_group[group] = number;
    }
    Body& body = bodies[number];
    for (Complex& z : corners[i]) z -= body.origin;
    for (std::size_t c = 0; c < corners[i].size(); c += 3)
      body.area += std::abs(doubled_area(corners[i][c], corners[i][c + 1], corners[i][c + 2])) / 2;
    body.islands.push_back(i);
    body.outline.append(Outline::around_triangles(corners[i]));
    if (options.locks.empty()) continue;
    const IslandLock& lock = element(options.locks, i);
    if (lock.rotation) body.turns = IslandTurns::none;
    body.keeps_scale |= lock.scale;
    body.keeps_place |= lock.place;
  }
  return bodies;
}

bool lies_along_axes(const Outline& outline) {
  double whole = 0, along = 0;
  outline.for_each_segment([&](Complex a, Complex b) {
    const Complex side = b - a;
    const double length = std::abs(side);
    whole += length;
    if (std::min(std::abs(side.real()), std::abs(side.imag())) <= tilt * length) along += length;
  });
  return 2 * along >= whole;
}

Array<Complex> turns_of(const Body& body, int directions, bool also_along_axes) {
  Array<Complex> within_quarter{1};
  if (body.turns == IslandTurns::any && (also_along_axes || !lies_along_axes(body.outline))) {
    const auto& points = body.outline.points();
    const Array<Complex> hull =
        convex_hull(Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size())));
    if (hull.size() > 1) within_quarter = {std::conj(longer_side(hull))};
    // Of what is hardly longer than rounding.
    if (!(std::abs(std::norm(within_quarter[0]) - 1) < same)) within_quarter[0] = 1;
    if (directions > 0) {
      Array<Complex> further;
      add_between(1, quarter_turned(1), directions, further);
      for (std::size_t i = 1; i < further.size(); ++i) within_quarter.push_back(further[i] * within_quarter[0]);
      within_quarter.push_back(squarest_turn(hull));
    }
  }
  if (body.turns == IslandTurns::none) return {1};
  Array<Complex> out;
  for (Complex turn : within_quarter) {
    for (int quarter = 0; quarter < 4; ++quarter, turn = quarter_turned(turn)) out.push_back(turn);
  }
  return out;
}

Array<Pose> poses_of(const Outline& outline, const Array<Complex>& turns, double scale, const Box& room) {
  const double width = room.right - room.left, height = room.top - room.bottom;
  Array<Pose> out;
  for (const Complex turn : turns) {
    const Outline turned = outline.moved(turn * scale, 0);
    const Box box = turned.box();
    if (!(box.right - box.left <= width && box.top - box.bottom <= height)) continue;
    const Complex shift(-box.left, -box.bottom);
    Outline placed = turned.moved(1, shift);
    Footprint footprint(placed);
    Pose pose{turn, shift, std::move(placed), box.right - box.left, box.top - box.bottom, std::move(footprint)};
    const auto is_known = [&](const Pose& other) { return is_same(other, pose); };
    if (std::none_of(out.begin(), out.end(), is_known)) out.push_back(std::move(pose));
  }
  return out;
}

}  // namespace lsgp
