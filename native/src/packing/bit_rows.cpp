// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/bit_rows.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_drawn_row = 30;

// What a row of texels contains of a line.
struct Reach {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  // The part of a segment between two heights.
  void add_segment(Complex a, Complex b, double bottom, double top) {
    if (a.imag() > b.imag()) std::swap(a, b);
    if (a.imag() > top || b.imag() < bottom) return;
    const double rise = b.imag() - a.imag(), run = b.real() - a.real();
    add(a.imag() >= bottom ? a.real() : a.real() + run * ((bottom - a.imag()) / rise));
    add(b.imag() <= top ? b.real() : a.real() + run * ((top - a.imag()) / rise));
  }
  // The part of a disk between two heights.
  void add_disk(Complex middle, double radius, double bottom, double top) {
    const double away = std::max({0.0, bottom - middle.imag(), middle.imag() - top});
    if (away >= radius) return;
    const double half = std::sqrt(radius * radius - away * away);
    add(middle.real() - half);
    add(middle.real() + half);
  }
};

// Rounded down and up, from 0 to `most`; without the calls that std::floor and std::ceil are on old processors.
int floor_up_to(int most, double number) {
  return static_cast<int>(std::clamp(number, 0.0, static_cast<double>(most)));
}
int ceil_up_to(int most, double number) {
  const double within = std::clamp(number, 0.0, static_cast<double>(most));
  const int whole = static_cast<int>(within);
  return whole < within ? whole + 1 : whole;
}

// The texels near a segment.
void draw_segment(Complex a, Complex b, double reach, BitRows& raster) {
  const double length = std::abs(b - a);
  const Complex away = length > 0 ? Complex(a.imag() - b.imag(), b.real() - a.real()) * (reach / length) : Complex(0);
  const double low = std::min(a.imag(), b.imag()) - reach, high = std::max(a.imag(), b.imag()) + reach;
  const int first = floor_up_to(raster.rows(), low);
  const int end = std::max(ceil_up_to(raster.rows(), high), floor_up_to(raster.rows(), low + 1));
  for (int row = first; row < end; ++row) {
    Reach found;
    found.add_segment(a + away, b + away, row, row + 1.0);
    if (reach > 0) {
      found.add_segment(a - away, b - away, row, row + 1.0);
      found.add_disk(a, reach, row, row + 1.0);
      found.add_disk(b, reach, row, row + 1.0);
    }
    if (found.low > found.high) continue;
    const int begin = floor_up_to(raster.columns(), found.low);
    raster.set(row, begin, std::max(ceil_up_to(raster.columns(), found.high), begin + 1));
  }
}

struct Crossing {
  double x;
  int winding;
};

// The texels whose middle line is inside: of those that no segment touches, all that are inside.
void fill(const Outline& outline, BitRows& raster) {
  const auto rows_crossed = [&](Complex a, Complex b) {
    const auto [low, high] = std::minmax({a.imag(), b.imag()});
    return std::pair(ceil_up_to(raster.rows(), low - 0.5), ceil_up_to(raster.rows(), high - 0.5));
  };
  // Those of each row follow each other.
  Array<Index> begin(raster.rows() + 1, 0);
  outline.for_each_segment([&](Complex a, Complex b) {
    const auto [first, end] = rows_crossed(a, b);
    for (int row = first; row < end; ++row) ++begin[row + 1];
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Array<Crossing> crossings(begin.back());
  Array<Index> next(begin.begin(), begin.end() - 1);
  outline.for_each_segment([&](Complex a, Complex b) {
    const auto [first, end] = rows_crossed(a, b);
    const int winding = a.imag() < b.imag() ? 1 : -1;
    if (winding < 0) std::swap(a, b);
    for (int row = first; row < end; ++row) {
      const double share = (row + 0.5 - a.imag()) / (b.imag() - a.imag());
      crossings[next[row]++] = {a.real() + share * (b.real() - a.real()), winding};
    }
  });
  for (int row = 0; row < raster.rows(); ++row) {
    const auto of_row = crossings.begin() + begin[row], end = crossings.begin() + begin[row + 1];
    std::sort(of_row, end,
              [](const Crossing& a, const Crossing& b) { return a.x != b.x ? a.x < b.x : a.winding < b.winding; });
    int winding = 0;
    for (auto crossing = of_row; end - crossing > 1; ++crossing) {
      winding += crossing->winding;
      if (winding == 0) continue;
      raster.set(row, floor_up_to(raster.columns(), crossing->x), ceil_up_to(raster.columns(), (crossing + 1)->x));
    }
  }
}

}  // namespace

void draw(const Outline& outline, double reach, BitRows& raster) {
  outline.for_each_segment([&](Complex a, Complex b) {
    draw_segment(a, b, reach, raster);
    checkpoint(operations_a_drawn_row * (std::abs(b.imag() - a.imag()) + 2 * reach + 2));
  });
  fill(outline, raster);
}

}  // namespace lsgp
