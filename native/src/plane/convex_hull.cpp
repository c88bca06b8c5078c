// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plane/predicates.hpp"

namespace lsgp {

namespace {

// Differences of this share of a length, or of an area, are taken for rounding, which must not choose between turns of
// a layout that are equally good.
constexpr double rounding = 1e-9;

// Removes the points inside the polygon of the extreme ones (Akl and Toussaint 1978), which leaves few of a layout.
Array<Complex> outer_points(const Eigen::VectorXcd& position) {
  std::array<Complex, 8> extreme;  // counter-clockwise, in eight directions
  extreme.fill(position[0]);
  for (const Complex z : position) {
    for (std::size_t i = 0; i < extreme.size(); ++i) {
      constexpr int x[]{1, 1, 0, -1, -1, -1, 0, 1}, y[]{0, 1, 1, 1, 0, -1, -1, -1};
      if (x[i] * (z.real() - extreme[i].real()) + y[i] * (z.imag() - extreme[i].imag()) > 0) extreme[i] = z;
    }
  }
  Array<Complex> outer;
  for (const Complex z : position) {
    bool inside = true;
    for (std::size_t i = 0; i < extreme.size() && inside; ++i) {
      const Complex side = extreme[(i + 1) % extreme.size()] - extreme[i];
      inside = side == 0.0 || cross(side, z - extreme[i]) > 0;
    }
    if (!inside) outer.push_back(z);
  }
  if (outer.empty()) outer.push_back(position[0]);  // all of them are at one place
  return outer;
}

// A polygon that begins at the lowest of its leftmost points, whichever of them rounding has put furthest to the left.
Array<Complex> from_lowest_on_the_left(const Array<Complex>& polygon) {
  const Extent extent = extent_along(polygon, 1);
  const double left = extent.low.real() + rounding * std::max(extent.width(), extent.height());
  std::size_t first = 0;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const bool is_lower = polygon[i].imag() < polygon[first].imag();
    if (polygon[i].real() <= left && (polygon[first].real() > left || is_lower)) first = i;
  }
  Array<Complex> out(polygon);
  std::rotate(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
  return out;
}

}  // namespace

Array<Complex> convex_hull(const Eigen::VectorXcd& position) {
  Array<Complex> points = outer_points(position);
  std::sort(points.begin(), points.end(),
            [](Complex a, Complex b) { return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag(); });
  Array<Complex> hull;
  const auto add_chain = [&](const auto& begin, const auto& end) {
    const std::size_t base = hull.size();
    for (auto point = begin; point != end; ++point) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();  // the other chain begins with it
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  if (hull.empty()) hull.push_back(points.front());
  return hull;
}

double area_of_hull(const Array<Complex>& hull) {
  double doubled = 0;
  for (std::size_t i = 2; i < hull.size(); ++i) doubled += doubled_area(hull[0], hull[i - 1], hull[i]);
  return doubled / 2;
}

Complex longer_side(const Array<Complex>& polygon) {
  const Array<Complex> hull = from_lowest_on_the_left(polygon);
  Complex best(1, 0);
  double smallest = std::numeric_limits<double>::infinity();
  const std::size_t count = hull.size();
  std::size_t right = 0, top = 0, left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Complex edge = hull[(i + 1) % count] - hull[i];
    if (!(std::abs(edge) > 0)) continue;
    const Complex along = edge / std::abs(edge);
    const auto at = [&](std::size_t j) { return (hull[j % count] - hull[i]) * std::conj(along); };
    const auto move_on = [&](std::size_t from, std::size_t& point, const auto& height) {
      point = std::max(point, from);
      while (point < i + count && height(at(point + 1)) >= height(at(point))) ++point;
    };
    move_on(i + 1, right, [](Complex z) { return z.real(); });
    move_on(right, top, [](Complex z) { return z.imag(); });
    move_on(top, left, [](Complex z) { return -z.real(); });
    const double width = at(right).real() - std::min(0.0, at(left).real()), height = at(top).imag();
    if (width * height < smallest * (1 - rounding)) {
      smallest = width * height;
      best = is_wide(width, height) ? along : along * Complex(0, 1);
    }
  }
  return best;
}

bool is_wide(double width, double height) { return width >= height * (1 - rounding); }

Extent extent_along(const Array<Complex>& points, Complex along) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double left = infinity, right = -infinity, bottom = infinity, top = -infinity;
  for (const Complex point : points) {
    const Complex turned = point * std::conj(along);
    left = std::min(left, turned.real());
    right = std::max(right, turned.real());
    bottom = std::min(bottom, turned.imag());
    top = std::max(top, turned.imag());
  }
  return {{left, bottom}, {right, top}};
}

}  // namespace lsgp
