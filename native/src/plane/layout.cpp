// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "plane/convex_hull.hpp"

namespace lsgp {

namespace {

constexpr double margin = 0.01;  // between islands, of the unit square's side before scaling
constexpr double infinity = std::numeric_limits<double>::infinity();

struct IslandBox {
  double width, height;
};

// Orders boxes by height, the highest first; those of one height but for rounding remain in the order of their numbers.
Array<std::size_t> by_height(const Array<IslandBox>& boxes) {
  constexpr double steps = 0x1p30;
  double highest = 0;
  for (const IslandBox& box : boxes) highest = std::max(highest, box.height);
  const auto steps_high = [&](std::size_t i) { return std::round(boxes[i].height / highest * steps); };
  Array<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return steps_high(a) > steps_high(b); });
  return order;
}

// Puts boxes on shelves about as wide as all of them are high; returns the origin of each.
struct Shelves {
  Array<Complex> place;
  double size;  // of the square that holds them
};
Shelves shelve(const Array<IslandBox>& boxes, double gap) {
  double total = 0, widest = 0;
  for (const IslandBox& box : boxes) {
    total += box.width * box.height;
    widest = std::max(widest, box.width);
  }
  const double shelf_width = std::max(widest, 1.05 * std::sqrt(total)) + gap;
  Shelves out{Array<Complex>(boxes.size()), 0};
  double x = 0, y = 0, shelf_height = 0, right = 0;
  for (const std::size_t i : by_height(boxes)) {
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

// The rotation that lays the longer side of the box around a convex polygon along u: of the box along the preferred
// axes if that is hardly larger than the smallest box, otherwise of the smallest.
Complex turn_of(const Array<Complex>& hull, std::optional<Complex> axes) {
  constexpr double larger = 1.2;
  const auto area = [](const Extent& extent) { return extent.width() * extent.height(); };
  const Complex side = longer_side(hull);
  if (!axes) return std::conj(side);
  const Extent aligned = extent_along(hull, std::conj(*axes));
  if (area(aligned) > larger * area(extent_along(hull, side))) return std::conj(side);
  return is_wide(aligned.width(), aligned.height()) ? *axes : *axes * Complex(0, -1);
}

}  // namespace

Complex upright(const Eigen::VectorXcd& position) { return longer_side(convex_hull(position)); }

Array<Similarity> arrange(const Array<Island>& islands) {
  Array<Similarity> out(islands.size());
  Array<IslandBox> boxes;
  double total = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const Array<Complex> hull = convex_hull(islands[i].position);
    out[i].turn = islands[i].turn.value_or(turn_of(hull, islands[i].axes));
    const Extent extent = extent_along(hull, std::conj(out[i].turn));
    out[i].shift = -extent.low;
    boxes.push_back({extent.width(), extent.height()});
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
  constexpr double rounding = 1e-6;  // cells, within which places are put onto the lattice
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
      // What lies on a line of the lattice but for rounding belongs to the cell beyond it, whatever the last digits.
      const double column = std::floor((z.real() + rounding) / width), row = std::floor((z.imag() + rounding) / height);
      Span& span = spans[first + layout.part[i]];
      span = {std::min(span.left, column), std::max(span.right, column + 1), std::min(span.bottom, row),
              std::max(span.top, row + 1)};
    }
  }
  Array<IslandBox> boxes;
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
