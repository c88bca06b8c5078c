// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lsgp {

namespace {

constexpr double margin = 0.01;  // between islands, of the unit square's side before scaling
constexpr double infinity = std::numeric_limits<double>::infinity();

double cross(Complex a, Complex b) { return std::imag(std::conj(a) * b); }

// The points without those inside the polygon of the extreme ones (Akl and Toussaint 1978), hardly any of a layout's.
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
  return outer;
}

// Counter-clockwise convex hull (Andrew's monotone chain).
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

struct Box {
  double width, height;
};

// Puts boxes on shelves about as wide as all together are high; returns where each begins.
struct Shelves {
  Array<Complex> place;
  double size;  // of the square that holds them
};
Shelves shelve(const Array<Box>& boxes, double gap) {
  double total = 0, widest = 0;
  for (const Box& box : boxes) {
    total += box.width * box.height;
    widest = std::max(widest, box.width);
  }
  Array<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return boxes[a].height > boxes[b].height; });
  const double shelf_width = std::max(widest, 1.05 * std::sqrt(total)) + gap;
  Shelves out{Array<Complex>(boxes.size()), 0};
  double x = 0, y = 0, shelf_height = 0, right = 0;
  for (const std::size_t i : order) {
    if (x > 0 && x + boxes[i].width > shelf_width) {
      y += shelf_height + gap;
      x = shelf_height = 0;
    }
    out.place[i] = {x, y};
    right = std::max(right, x + boxes[i].width);
    shelf_height = std::max(shelf_height, boxes[i].height);
    x += boxes[i].width + gap;
  }
  out.size = std::max(right, y + shelf_height);
  return out;
}

// The unit vector along the longer side of the smallest box around a convex polygon. One side of that box lies on an
// edge, and as edges turn, the points that touch the others only move on (rotating calipers, Toussaint 1983).
Complex longer_side(const Array<Complex>& hull) {
  Complex best(1, 0);
  double smallest = infinity;
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
    if (width * height < smallest * (1 - 1e-9)) {
      smallest = width * height;
      best = width >= height ? along : along * Complex(0, 1);
    }
  }
  return best;
}

}  // namespace

Complex upright(const Eigen::VectorXcd& position) { return longer_side(convex_hull(position)); }

Array<Similarity> arrange(const Array<Island>& islands) {
  Array<Similarity> out(islands.size());
  Array<Box> boxes;
  double total = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const Array<Complex> hull = convex_hull(islands[i].position);
    out[i].turn = islands[i].turn.value_or(std::conj(longer_side(hull)));
    double left = infinity, right = -infinity, bottom = infinity, top = -infinity;
    for (const Complex point : hull) {
      const Complex turned = point * out[i].turn;
      left = std::min(left, turned.real());
      right = std::max(right, turned.real());
      bottom = std::min(bottom, turned.imag());
      top = std::max(top, turned.imag());
    }
    out[i].shift = -Complex(left, bottom);
    boxes.push_back({right - left, top - bottom});
    total += boxes.back().width * boxes.back().height;
  }
  const Shelves shelves = shelve(boxes, islands.size() > 1 ? margin * std::sqrt(total) : 0.0);
  for (std::size_t i = 0; i < islands.size(); ++i) {
    out[i].shift += shelves.place[i];
    if (shelves.size > 0) out[i].divisor = shelves.size;
  }
  for (std::size_t i = 0; i < islands.size(); ++i) {
    if (!islands[i].pin) continue;
    const auto [point, place] = *islands[i].pin;
    const Complex move = place - out[i](islands[i].position[point]);
    for (std::size_t k = 0; k < islands.size(); ++k) {
      if (islands[k].component == islands[i].component) out[k].move += move;
    }
  }
  return out;
}

void arrange_on_lattice(const Array<DividedLayout>& layouts, const PointLattice& lattice, int step) {
  // Rows of the lattice that have points straight above each other.
  const double width = step, height = step * (lattice.square() ? 1 : 2 * lattice.generator().imag());
  struct Span {
    double left = infinity, right = -infinity, bottom = infinity, top = -infinity;  // in steps
  };
  Array<Span> spans;
  for (const DividedLayout& layout : layouts) {
    const Eigen::Index first = ssize(spans);
    spans.resize(first + layout.part_count);
    for (Eigen::Index i = 0; i < layout.position->size(); ++i) {
      const Complex z = (*layout.position)[i];
      const double column = std::floor(z.real() / width), row = std::floor(z.imag() / height);
      Span& span = spans[first + layout.part[i]];
      span = {std::min(span.left, column), std::max(span.right, column + 1), std::min(span.bottom, row),
              std::max(span.top, row + 1)};
    }
  }
  Array<Box> boxes;
  for (const Span& span : spans) boxes.push_back({span.right - span.left, span.top - span.bottom});
  const Shelves shelves = shelve(boxes, 0);
  Index first = 0;
  for (const DividedLayout& layout : layouts) {
    for (Eigen::Index i = 0; i < layout.position->size(); ++i) {
      const Index part = first + layout.part[i];
      const Complex steps = shelves.place[part] - Complex(spans[part].left, spans[part].bottom);
      (*layout.position)[i] += Complex(steps.real() * width, steps.imag() * height);
    }
    first += layout.part_count;
  }
}

}  // namespace lsgp
