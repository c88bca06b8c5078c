// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/coverage_raster.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr double most_cells_across = 1024;

}  // namespace

CoverageRaster::CoverageRaster(const Box& frame, double cell)
    : frame_(frame),
      cell_(std::max(
          {cell, (frame.right - frame.left) / most_cells_across, (frame.top - frame.bottom) / most_cells_across})),
      columns_(1 + static_cast<Index>((frame.right - frame.left) / cell_)),
      rows_(1 + static_cast<Index>((frame.top - frame.bottom) / cell_)),
      cells_left_((columns_ + 1) * rows_, 0) {}

template <typename Visit>
void CoverageRaster::for_each_crossing(Complex tail, Complex head, Visit visit) const {
  const auto [below, above] = std::minmax({row_of(tail.imag()), row_of(head.imag())});
  const double first = std::max(std::ceil(below), 0.0), end = std::min(std::ceil(above), static_cast<double>(rows_));
  if (!(first < end)) return;
  const double slope = (head.real() - tail.real()) / (head.imag() - tail.imag());
  const Index direction = head.imag() > tail.imag() ? 1 : -1;
  for (Index row = static_cast<Index>(first); row < static_cast<Index>(end); ++row) {
    const double y = frame_.bottom + (row + 0.5) * cell_;
    const double cells = (tail.real() + slope * (y - tail.imag()) - frame_.left) / cell_;
    visit(row, std::clamp(cells, 0.0, static_cast<double>(columns_)), direction);
  }
}

void CoverageRaster::add(Complex tail, Complex head) {
  for_each_crossing(tail, head, [&](Index row, double cells, Index direction) {
    // It covers the cells left of it.
    Index* const change = &cells_left_[row * (columns_ + 1)];
    change[0] += direction;
    change[static_cast<Index>(std::lround(cells))] -= direction;
  });
}

void CoverageRaster::sum_up() {
  for (Index row = 0; row < rows_; ++row) {
    Index* const left = &cells_left_[row * (columns_ + 1)];
    Index cover = 0, sum = 0;
    for (Index column = 0; column <= columns_; ++column) {
      cover += left[column];
      left[column] = sum;
      sum += cover;
    }
  }
}

double CoverageRaster::doubly_covered() const {
  double pairs = 0;
  for (Index row = 0; row < rows_; ++row) {
    const Index* const left = &cells_left_[row * (columns_ + 1)];
    for (Index column = 0; column < columns_; ++column) {
      const double cover = left[column + 1] - left[column];
      pairs += cover * (cover - 1) / 2;
    }
  }
  return pairs * cell_ * cell_;
}

double CoverageRaster::shared(Complex tail, Complex head) const {
  double sum = 0;
  for_each_crossing(tail, head, [&](Index row, double cells, Index direction) {
    const Index whole = std::min(static_cast<Index>(cells), columns_ - 1);
    const Index at = row * (columns_ + 1) + whole;
    const double left = cells_left_[at] + (cells - whole) * (cells_left_[at + 1] - cells_left_[at]);
    sum += direction * left;
  });
  return sum * cell_ * cell_;
}

}  // namespace lsgp
