// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/winding_raster.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr double least_length = 1e-300;

Index cells_along(Index triangle_count, double length, double width) {
  constexpr double cells_per_triangle = 1, most = 4096;
  const double aspect = length > 0 && width > 0 ? length / width : 1;
  return static_cast<Index>(std::clamp(std::sqrt(cells_per_triangle * triangle_count * aspect), 1.0, most));
}

Index cell_of(double cells, Index count) { return static_cast<Index>(std::clamp(cells, 0.0, count - 1.0)); }

}  // namespace

WindingRaster::WindingRaster(const BoundaryPolygon& boundary, const Box& frame, Index triangle_count)
    : frame_(frame),
      rounding_(1e-12 * std::max({-frame.left, frame.right, -frame.bottom, frame.top})),
      columns_(cells_along(triangle_count, frame.right - frame.left, frame.top - frame.bottom)),
      rows_(cells_along(triangle_count, frame.top - frame.bottom, frame.right - frame.left)),
      columns_per_unit_(columns_ / std::max(frame.right - frame.left, least_length)),
      rows_per_unit_(rows_ / std::max(frame.top - frame.bottom, least_length)),
      passage_(columns_ * rows_),
      winding_((columns_ + 1) * (rows_ + 1), 0),
      doubtful_(winding_.size(), 0) {
  for (Index edge = 0; edge < boundary.edge_count(); ++edge) {
    const Complex tail = boundary.tail(edge), head = boundary.head(edge);
    const auto [bottom, top] = std::minmax({tail.imag(), head.imag()});
    const Index last = row_of(top + rounding_);
    for (Index row = row_of(bottom - rounding_); row <= last; ++row) {
      pass(boundary, edge, row);
      wind(tail, head, row);
    }
    wind(tail, head, last + 1);
  }
  for (Index row = 0; row <= rows_; ++row) {
    Index* winding = &winding_[row * (columns_ + 1)];
    for (Index column = 0; column < columns_; ++column) winding[column + 1] += winding[column];
  }
  for (Index row = 0; row < rows_; ++row) {
    const Index corner = row * (columns_ + 1), above = corner + columns_ + 1;
    Index in_row = 0;
    for (Index column = 0; column < columns_; ++column) {
      in_row += may_be_covered_twice(row, column) ? 1 : 0;
      doubtful_[above + column + 1] = doubtful_[corner + column + 1] + in_row;
    }
  }
}

bool WindingRaster::meets(const Box& box) const {
  const Index left = column_of(box.left), right = column_of(box.right) + 1;
  const Index below = row_of(box.bottom) * (columns_ + 1), above = (row_of(box.top) + 1) * (columns_ + 1);
  return doubtful_[above + right] - doubtful_[above + left] - doubtful_[below + right] + doubtful_[below + left] > 0;
}

Index WindingRaster::column_of(double x) const { return cell_of((x - frame_.left) * columns_per_unit_, columns_); }
Index WindingRaster::row_of(double y) const { return cell_of((y - frame_.bottom) * rows_per_unit_, rows_); }
double WindingRaster::bottom_of(Index row) const { return frame_.bottom + row / rows_per_unit_; }

// Marks the cells of a row that an edge passes, or may pass within rounding.
void WindingRaster::pass(const BoundaryPolygon& boundary, Index edge, Index row) {
  const Complex tail = boundary.tail(edge), along = boundary.head(edge) - tail;
  double begin = 0, end = 1;  // of what lies in the row, as shares of the edge
  if (along.imag() != 0) {
    begin = std::clamp((bottom_of(row) - rounding_ - tail.imag()) / along.imag(), 0.0, 1.0);
    end = std::clamp((bottom_of(row + 1) + rounding_ - tail.imag()) / along.imag(), 0.0, 1.0);
  }
  const auto [left, right] = std::minmax({tail.real() + begin * along.real(), tail.real() + end * along.real()});
  const Index last = column_of(right + rounding_);
  for (Index column = column_of(left - rounding_); column <= last; ++column) {
    Passage& passage = passage_[row * columns_ + column];
    if (passage.first == none) passage.first = edge;
    const Complex first = boundary.head(passage.first) - boundary.tail(passage.first);
    const bool is_next = passage.last == edge - 1 && boundary.runs_on(edge);
    passage.is_plain =
        passage.is_plain && (passage.first == edge || is_next) && std::real(along * std::conj(first)) > 0;
    passage.last = edge;
  }
}

// Records the change of the winding number from left to right where an edge crosses the lower side of a row.
void WindingRaster::wind(Complex tail, Complex head, Index row) {
  const double y = bottom_of(row);
  if ((tail.imag() <= y) == (head.imag() <= y)) return;
  const double x = tail.real() + (y - tail.imag()) / (head.imag() - tail.imag()) * (head.real() - tail.real());
  winding_[row * (columns_ + 1) + column_of(x) + 1] += tail.imag() > y ? 1 : -1;
}

// A plain run of edges crosses a straight line from alternating sides, so if nothing else passes a cell, the winding
// numbers of any two points in it differ by at most one.
bool WindingRaster::may_be_covered_twice(Index row, Index column) const {
  const Passage& passage = passage_[row * columns_ + column];
  const Index below = row * (columns_ + 1) + column, above = below + columns_ + 1;
  const auto [least, most] = std::minmax({winding_[below], winding_[below + 1], winding_[above], winding_[above + 1]});
  return most > 1 || !passage.is_plain || (passage.first != none && least > 0);
}

}  // namespace lsgp
