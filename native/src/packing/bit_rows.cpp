// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/bit_rows.hpp"

#include <cmath>
#include <limits>

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

int clamped(double number, int least, int most) {
  return static_cast<int>(std::clamp(number, static_cast<double>(least), static_cast<double>(most)));
}

// The texels near a segment.
void draw_segment(Complex a, Complex b, double reach, BitRows& raster) {
  const double length = std::abs(b - a);
  const Complex away = length > 0 ? Complex(a.imag() - b.imag(), b.real() - a.real()) * (reach / length) : Complex(0);
  const double low = std::min(a.imag(), b.imag()) - reach, high = std::max(a.imag(), b.imag()) + reach;
  const int end = clamped(std::max(std::ceil(high), std::floor(low) + 1), 0, raster.rows());
  for (int row = clamped(std::floor(low), 0, raster.rows()); row < end; ++row) {
    Reach found;
    found.add_segment(a + away, b + away, row, row + 1.0);
    if (reach > 0) {
      found.add_segment(a - away, b - away, row, row + 1.0);
      found.add_disk(a, reach, row, row + 1.0);
      found.add_disk(b, reach, row, row + 1.0);
    }
    if (found.low > found.high) continue;
    const int begin = clamped(std::floor(found.low), 0, raster.columns());
    raster.set(row, begin, std::max(clamped(std::ceil(found.high), 0, raster.columns()), begin + 1));
  }
}

struct Crossing {
  int row;
  double x;
  int winding;
};

// The texels whose middle line is inside: of those that no segment touches, all that are inside.
void fill(const Outline& outline, BitRows& raster) {
  Array<Crossing> crossings;
  outline.for_each_segment([&](Complex a, Complex b) {
    const int winding = a.imag() < b.imag() ? 1 : -1;
    if (winding < 0) std::swap(a, b);
    const int end = clamped(std::ceil(b.imag() - 0.5), 0, raster.rows());
    for (int row = clamped(std::ceil(a.imag() - 0.5), 0, raster.rows()); row < end; ++row) {
      const double share = (row + 0.5 - a.imag()) / (b.imag() - a.imag());
      crossings.push_back({row, a.real() + share * (b.real() - a.real()), winding});
    }
  });
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.row != b.row ? a.row < b.row : a.x != b.x ? a.x < b.x : a.winding < b.winding;
  });
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].winding;
    if (winding == 0) continue;
    raster.set(crossings[i].row, clamped(std::floor(crossings[i].x), 0, raster.columns()),
               clamped(std::ceil(crossings[i + 1].x), 0, raster.columns()));
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
