// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/sliding.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/checkpoint.hpp"
#include "packing/gaps.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_pair = 5;
constexpr int most_cells = 256;  // of a side

struct Segment {
  Complex a, b;
  Box box;
};

Complex along(Axis axis, Complex z) { return axis == Axis::u ? z : Complex(z.imag(), z.real()); }

Box along(Axis axis, const Box& box) { return axis == Axis::u ? box : Box{box.bottom, box.top, box.left, box.right}; }

Box around_segment(Complex a, Complex b) {
  return {std::min(a.real(), b.real()), std::max(a.real(), b.real()), std::min(a.imag(), b.imag()),
          std::max(a.imag(), b.imag())};
}

}  // namespace

double travel_to_segment(Complex point, Complex a, Complex b, double gap, double limit) {
  if (a.imag() > b.imag()) std::swap(a, b);
  const double x = point.real(), y = point.imag();
  if (y < a.imag() - gap || y > b.imag() + gap) return limit;
  double least = limit;
  const auto meet_at = [&](double at) { least = std::min(least, std::max(x - at, 0.0)); };
  for (const Complex end : {a, b}) {
    const double away = y - end.imag();
    if (x >= end.real() && std::abs(away) < gap) meet_at(end.real() + std::sqrt(gap * gap - away * away));
  }
  // The side of the segment that looks along u, shifted by the gap.
  const double rise = b.imag() - a.imag(), run = b.real() - a.real();
  if (rise > 0) {
    const double length = std::sqrt(rise * rise + run * run);
    const double up = -gap * run / length;
    const double share = (y - a.imag() - up) / rise;
    if (share >= 0 && share <= 1) {
      const double on_segment = a.real() + (y - a.imag()) / rise * run;
      if (x >= on_segment) meet_at(a.real() + share * run + gap * rise / length);
    }
  }
  return least;
}

StillOutlines::StillOutlines(double width, double height, double cell)
    : column_count_(std::clamp(static_cast<int>(width / cell), 1, most_cells)),
      row_count_(std::clamp(static_cast<int>(height / cell), 1, most_cells)),
      cell_(std::max(width / column_count_, height / row_count_)),
      in_cell_(column_count_ * row_count_) {}

template <typename Visit>
void StillOutlines::for_each_cell(const Box& box, Visit visit) const {
  const auto cell_of = [&](double at, int count) {
    return static_cast<int>(std::clamp(at / cell_, 0.0, static_cast<double>(count - 1)));
  };
  for (int row = cell_of(box.bottom, row_count_); row <= cell_of(box.top, row_count_); ++row) {
    for (int column = cell_of(box.left, column_count_); column <= cell_of(box.right, column_count_); ++column)
      visit(row * column_count_ + column);
  }
}

void StillOutlines::add(Outline outline) {
  const auto number = static_cast<Index>(outlines_.size());
  boxes_.push_back(outline.box());
  for_each_cell(boxes_.back(), [&](int cell) { in_cell_[cell].push_back(number); });
  outlines_.push_back(std::move(outline));
  seen_.push_back(-1);
}

bool StillOutlines::has_room(const Outline& outline, double gap, double& looks) const {
  Box around_it = outline.box();
  around_it = {around_it.left - gap, around_it.right + gap, around_it.bottom - gap, around_it.top + gap};
  bool is_free = true;
  ++query_;
  for_each_cell(around_it, [&](int cell) {
    for (const Index number : in_cell_[cell]) {
      if (!is_free || seen_[number] == query_) continue;
      seen_[number] = query_;
      if (!meet(boxes_[number], around_it)) continue;
      const double pairs = static_cast<double>(outline.points().size() * outlines_[number].points().size());
      looks += pairs;
      checkpoint(operations_a_pair * pairs);
      is_free = are_apart(outline, outlines_[number], gap);
    }
  });
  return is_free;
}

double StillOutlines::free_way(const Outline& moving, Axis axis, double gap, double limit, double& looks) const {
  Box swept = moving.box();
  swept = {swept.left - gap, swept.right + gap, swept.bottom - gap, swept.top + gap};
  (axis == Axis::u ? swept.left : swept.bottom) -= limit;
  const Box swept_along = along(axis, swept);
  Array<Segment> near;
  ++query_;
  for_each_cell(swept, [&](int cell) {
    for (const Index number : in_cell_[cell]) {
      if (seen_[number] == query_) continue;
      seen_[number] = query_;
      if (!meet(boxes_[number], swept)) continue;
      outlines_[number].for_each_segment([&](Complex a, Complex b) {
        const Complex tail = along(axis, a), head = along(axis, b);
        const Box box = around_segment(tail, head);
        if (meet(box, swept_along)) near.push_back({tail, head, box});
      });
    }
  });
  double least = limit;
  moving.for_each_segment([&](Complex a, Complex b) {
    const Complex tail = along(axis, a), head = along(axis, b);
    const auto [left, right, bottom, top] = around_segment(tail, head);
    for (const Segment& segment : near) {
      // Beside its way, behind it, or farther than what it meets first.
      if (segment.box.top + gap < bottom || segment.box.bottom - gap > top || segment.box.left - gap > right ||
          segment.box.right + gap < left - least)
        continue;
      least = travel_to_segment(tail, segment.a, segment.b, gap, least);
      // The other way round: a point moved along u is one that is moved against it in the mirror.
      for (const Complex point : {segment.a, segment.b}) {
        if (point.imag() < bottom - gap || point.imag() > top + gap) continue;
        least = travel_to_segment({-point.real(), point.imag()}, {-tail.real(), tail.imag()},
                                  {-head.real(), head.imag()}, gap, least);
      }
    }
    looks += static_cast<double>(near.size());
    checkpoint(operations_a_pair * static_cast<double>(near.size()));
  });
  return least;
}

}  // namespace lsgp
