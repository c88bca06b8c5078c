// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/coverage_raster.hpp"

#include <doctest/doctest.h>

#include <complex>

namespace {

using lsgp::Complex;

// Counter-clockwise, turned about its middle.
lsgp::Array<Complex> rectangle(Complex middle, double width, double height, double turn) {
  lsgp::Array<Complex> out;
  for (const Complex corner : {Complex(-1, -1), Complex(1, -1), Complex(1, 1), Complex(-1, 1)}) {
    out.push_back(middle + std::polar(0.5, turn) * Complex(width * corner.real(), height * corner.imag()));
  }
  return out;
}

template <typename Visit>
void for_each_side(const lsgp::Array<Complex>& polygon, Visit visit) {
  for (std::size_t i = 0; i < polygon.size(); ++i) visit(polygon[i], polygon[(i + 1) % polygon.size()]);
}

lsgp::CoverageRaster raster_of(const lsgp::Array<lsgp::Array<Complex>>& polygons) {
  lsgp::CoverageRaster raster({-2, 3, -2, 2}, 0.01);
  for (const auto& polygon : polygons) {
    for_each_side(polygon, [&](Complex tail, Complex head) { raster.add(tail, head); });
  }
  raster.sum_up();
  return raster;
}

double shared(const lsgp::CoverageRaster& raster, const lsgp::Array<Complex>& polygon) {
  double out = 0;
  for_each_side(polygon, [&](Complex tail, Complex head) { out += raster.shared(tail, head); });
  return out;
}

}  // namespace

TEST_CASE("what is covered more than once counts by pairs") {
  const auto square = rectangle(0, 2, 2, 0), beside = rectangle(1, 2, 2, 0), turned = rectangle(0, 1, 1, 0.6);
  CHECK(raster_of({square}).doubly_covered() == doctest::Approx(0));
  CHECK(raster_of({square, beside}).doubly_covered() == doctest::Approx(2).epsilon(0.01));
  CHECK(raster_of({square, turned}).doubly_covered() == doctest::Approx(1).epsilon(0.01));
  CHECK(raster_of({square, square, square}).doubly_covered() == doctest::Approx(12).epsilon(0.01));
}

TEST_CASE("an outline shares with a layout what it covers of it, layer by layer") {
  const auto square = rectangle(0, 2, 2, 0), beside = rectangle(1, 2, 2, 0);
  const auto raster = raster_of({square, beside});
  for (const double turn : {0.0, 0.4, 1.3}) {
    CAPTURE(turn);
    CHECK(shared(raster, rectangle(0.5, 0.4, 0.6, turn)) == doctest::Approx(2 * 0.24).epsilon(0.01));
    CHECK(shared(raster, rectangle({-0.5, 0.3}, 0.4, 0.6, turn)) == doctest::Approx(0.24).epsilon(0.01));
    CHECK(shared(raster, rectangle({20, -7}, 3, 3, turn)) == doctest::Approx(0));
    CHECK(shared(raster, rectangle(0.5, 50, 60, turn)) == doctest::Approx(8).epsilon(0.01));
  }
}
