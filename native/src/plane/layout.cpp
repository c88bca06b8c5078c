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
double area(const IslandBox& box) { return box.width * box.height; }

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
  double width = 0, height = 0;  // of the box that holds them
  double size() const { return std::max(width, height); }
};
Shelves shelve(const Array<IslandBox>& boxes, double gap) {
  double total = 0, widest = 0;
  for (const IslandBox& box : boxes) {
    total += area(box);
    widest = std::max(widest, box.width);
  }
  const double shelf_width = std::max(widest, 1.05 * std::sqrt(total)) + gap;
  Shelves out{Array<Complex>(boxes.size())};
  double x = 0, y = 0, shelf_height = 0;
  for (const std::size_t i : by_height(boxes)) {
    if (x > 0 && x + boxes[i].width > shelf_width) {
      y += shelf_height + gap;
      x = shelf_height = 0;
    }
    out.place[i] = {x, y};
    out.width = std::max(out.width, x + boxes[i].width);
    shelf_height = std::max(shelf_height, boxes[i].height);
    x += boxes[i].width + gap;
  }
  out.height = y + shelf_height;
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

// Of the lattice's translations, times the step.
struct Cell {
  double width, height;
};

struct PartExtent {
  Complex low{infinity, infinity}, high{-infinity, -infinity};
  // In cells.
  Complex first_cell{infinity, infinity}, last_cell{-infinity, -infinity};
  bool may_lie_anywhere = false;

  void add(Complex z, Complex cell) {
    low = {std::min(low.real(), z.real()), std::min(low.imag(), z.imag())};
    high = {std::max(high.real(), z.real()), std::max(high.imag(), z.imag())};
    first_cell = {std::min(first_cell.real(), cell.real()), std::min(first_cell.imag(), cell.imag())};
    last_cell = {std::max(last_cell.real(), cell.real()), std::max(last_cell.imag(), cell.imag())};
  }
  IslandBox box() const { return {(high - low).real(), (high - low).imag()}; }
  IslandBox box_of_cells() const { return {(last_cell - first_cell).real() + 1, (last_cell - first_cell).imag() + 1}; }
  bool is_scrap(const Cell& cell) const {
    constexpr double most_filled = 0.5;  // of its cells: beyond, a box around scraps saves none of them
    return may_lie_anywhere && area(box()) <= most_filled * area(box_of_cells()) * cell.width * cell.height;
  }
};

Array<PartExtent> extents_of_parts(const Array<DividedLayout>& layouts, const Cell& cell) {
  constexpr double rounding = 1e-6;  // cells, within which places are put onto the lattice
  Array<PartExtent> out;
  for (const DividedLayout& layout : layouts) {
    const Eigen::Index first = ssize(out);
    out.resize(first + layout.part_count);
    for (Eigen::Index i = 0; i < layout.position->size(); ++i) {
      const Complex z = (*layout.position)[i];
      // What lies on a line of the lattice but for rounding belongs to the cell beyond it, whatever the last digits.
      out[first + layout.part[i]].add(
          z, {std::floor((z.real() + rounding) / cell.width), std::floor((z.imag() + rounding) / cell.height)});
    }
    for (auto part = out.begin() + first; part != out.end(); ++part) part->may_lie_anywhere = layout.may_lie_anywhere;
  }
  return out;
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
    total += area(boxes.back());
  }
  const Shelves shelves = shelve(boxes, islands.size() > 1 ? margin * std::sqrt(total) : 0.0);
  for (std::size_t i = 0; i < islands.size(); ++i) {
    out[i].shift += shelves.place[i];
    if (shelves.size() > 0) out[i].divisor = shelves.size();
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
  const Cell cell{static_cast<double>(step), step * (lattice.square() ? 1 : 2 * lattice.generator().imag())};
  const Array<PartExtent> parts = extents_of_parts(layouts, cell);
  Array<IslandBox> scraps, boxes;
  double area_of_scraps = 0;
  for (const PartExtent& part : parts) {
    if (part.is_scrap(cell)) {
      scraps.push_back(part.box());
      area_of_scraps += area(scraps.back());
    } else {
      boxes.push_back(part.box_of_cells());
    }
  }
  constexpr double scrap_gap = 1 / 16.0;  // between scraps, of the side of a square as large as the mean of them
  const double gap = scraps.empty() ? 0 : scrap_gap * std::sqrt(area_of_scraps / static_cast<double>(scraps.size()));
  const Shelves together = shelve(scraps, gap);
  if (!scraps.empty()) {
    boxes.push_back({std::ceil((together.width + gap) / cell.width), std::ceil((together.height + gap) / cell.height)});
  }
  const Shelves shelves = shelve(boxes, 0);
  const auto in_cells = [&](Complex steps) { return Complex(steps.real() * cell.width, steps.imag() * cell.height); };
  Array<Complex> moves;
  std::size_t scrap = 0, box = 0;
  for (const PartExtent& part : parts) {
    if (part.is_scrap(cell)) {
      moves.push_back(in_cells(shelves.place.back()) + Complex(gap / 2, gap / 2) + together.place[scrap++] - part.low);
    } else {
      moves.push_back(in_cells(shelves.place[box++] - part.first_cell));
    }
  }
  Index first = 0;
  for (const DividedLayout& layout : layouts) {
    for (Eigen::Index i = 0; i < layout.position->size(); ++i) {
      (*layout.position)[i] += moves[first + layout.part[i]];
    }
    first += layout.part_count;
  }
}

}  // namespace lsgp
