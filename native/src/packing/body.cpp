// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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

// Of the order of bodies.
bool is_body_before(const Body& a, const Body& b) {
  const auto size = [](const Body& body) {
    const Box box = body.outline.box();
    return (box.right - box.left) + (box.top - box.bottom);
  };
  const auto kept = [](const Body& body) { return std::tuple(body.keeps_place, body.keeps_scale, body.turns); };
  const double size_of_a = size(a), size_of_b = size(b);
  if (size_of_a != size_of_b) return size_of_a > size_of_b;
  if (a.area != b.area) return a.area > b.area;
  if (kept(a) != kept(b)) return kept(a) < kept(b);
  // Those that keep their place differ by it alone, if they have one shape.
  if (a.keeps_place && a.origin != b.origin) return is_before(a.origin, b.origin);
  return is_before(a.outline.points(), b.outline.points());
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

Complex rounded_to(double quantum, Complex z) {
  if (!(quantum > 0)) return z;
  return {std::round(z.real() / quantum) * quantum, std::round(z.imag() / quantum) * quantum};
}

// The outline, area and hull of a body whose islands have these corners. Rounding does not hang on the order of
// islands, triangles or corners; far from the origin only what is divided after the difference keeps its digits.
void add_shape(const Array<Array<Complex>>& corners_of, double length, double quantum, Body& body) {
  constexpr double most = std::numeric_limits<double>::infinity();
  double left = most, bottom = most;
  for (const Index i : body.islands) {
    for (const Complex z : corners_of[i]) {
      left = std::min(left, z.real());
      bottom = std::min(bottom, z.imag());
    }
  }
  body.low = {left, bottom};
  body.origin = body.low / length;
  Array<double> areas;
  Array<Outline> outlines;
  for (const Index i : body.islands) {
    Array<Complex> corners = corners_of[i];
    for (Complex& z : corners) z = rounded_to(quantum, (z - body.low) / length);
    for (auto corner = corners.begin(); corner != corners.end(); corner += 3) {
      const auto first = std::min_element(corner, corner + 3, [](Complex a, Complex b) { return is_before(a, b); });
      std::rotate(corner, first, corner + 3);
      areas.push_back(std::abs(doubled_area(corner[0], corner[1], corner[2])) / 2);
    }
    outlines.push_back(Outline::around_triangles(corners));
  }
  std::sort(areas.begin(), areas.end());
  for (const double area : areas) body.area += area;
  std::sort(outlines.begin(), outlines.end(),
            [](const Outline& a, const Outline& b) { return is_before(a.points(), b.points()); });
  for (const Outline& outline : outlines) body.outline.append(outline);
  const auto& points = body.outline.points();
  body.hull = convex_hull(Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size())));
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

Array<Body> bodies_of(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options,
                      double length, double quantum) {
  Index island_count = 0;
  for (const Index i : island) island_count = std::max(island_count, i + 1);
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
      if (group >= 0) of_group[group] = number;
    }
    Body& body = bodies[number];
    body.islands.push_back(i);
    if (options.locks.empty()) continue;
    const IslandLock& lock = element(options.locks, i);
    if (lock.rotation) body.turns = IslandTurns::none;
    body.keeps_scale |= lock.scale;
    body.keeps_place |= lock.place;
  }
  for (Body& body : bodies) add_shape(corners, length, quantum, body);
  std::stable_sort(bodies.begin(), bodies.end(), is_body_before);
  return bodies;
}

Array<Box> boxes_of_islands(const CornerUv& corner_uv, const std::vector<Index>& island) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Index count = 0;
  for (const Index i : island) count = std::max(count, i + 1);
  Array<Box> out(count, Box{far, -far, far, -far});
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] < 0) continue;
    const auto corners = corner_uv.middleRows<3>(3 * static_cast<Eigen::Index>(t));
    const Eigen::RowVector2d low = corners.colwise().minCoeff(), high = corners.colwise().maxCoeff();
    out[island[t]] = around(out[island[t]], {low[0], high[0], low[1], high[1]});
  }
  return out;
}

UvRectangle inside_margins(const PackingOptions& options, bool has_area) {
  const double snap = options.snap;
  const double margin = snap > 0 ? std::ceil(options.margin / snap) * snap : options.margin;
  if (!has_area) return {margin, margin, margin + 1, margin + 1};
  const UvRectangle area = options.area.value_or(UvRectangle{});
  return {area.left + margin, area.bottom + margin, area.right - margin, area.top - margin};
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
    if (body.hull.size() > 1) within_quarter = {std::conj(longer_side(body.hull))};
    // Of what is hardly longer than rounding.
    if (!(std::abs(std::norm(within_quarter[0]) - 1) < same)) within_quarter[0] = 1;
    if (directions > 0) {
      Array<Complex> further;
      add_between(1, quarter_turned(1), directions, further);
      for (std::size_t i = 1; i < further.size(); ++i) within_quarter.push_back(further[i] * within_quarter[0]);
      within_quarter.push_back(squarest_turn(body.hull));
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
    Array<Box> holes = placed.hole_boxes();
    const double width = box.right - box.left, height = box.top - box.bottom;
    Pose pose{turn, shift, std::move(placed), width, height, std::move(footprint), std::move(holes)};
    const auto is_known = [&](const Pose& other) { return is_same(other, pose); };
    if (std::none_of(out.begin(), out.end(), is_known)) out.push_back(std::move(pose));
  }
  return out;
}

}  // namespace lsgp
