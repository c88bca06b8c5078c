// SPDX-License-Identifier: GPL-3.0-or-later
// Presets as callers of the C++ library use them.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "balls.hpp"
#include "lsgp/auto_unwrap.hpp"
#include "lsgp/errors.hpp"

using namespace lsgp;

namespace {

constexpr Index outer = 1200, inner = 500;  // triangles, about

Surface ball_in_a_ball() {
  Surface within = uneven_ball(inner);
  within.positions *= 0.3;
  return merged(uneven_ball(outer), within);
}

// The length in the map of a unit of length on the ball within, relative to that on the one around it.
double density_within(const Surface& surface, const Unwrapped& map) {
  const Eigen::Index first_within = uneven_ball(outer).triangles.rows();
  double area[2] = {0, 0}, mapped[2] = {0, 0};
  for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f) {
    const auto at = [&](int corner) { return Eigen::Vector3d(surface.positions.row(surface.triangles(f, corner))); };
    const auto uv = [&](int corner) { return Eigen::Vector2d(map.result.corner_uv.row(3 * f + corner)); };
    const bool is_within = f >= first_within;
    const Eigen::Vector2d u = uv(1) - uv(0), v = uv(2) - uv(0);
    area[is_within] += (at(1) - at(0)).cross(at(2) - at(0)).norm();
    mapped[is_within] += std::abs(u[0] * v[1] - u[1] * v[0]);
  }
  return std::sqrt(mapped[1] / area[1] * area[0] / mapped[0]);
}

}  // namespace

TEST_CASE("what nothing outside can see is as coarse as was asked for") {
  const Surface surface = ball_in_a_ball();
  AutoUnwrapOptions options;
  const double usual = density_within(surface, auto_unwrap(surface, {}, options));
  for (const double share : {0.5, 0.125, 1.0}) {
    options.inside = share;
    const Unwrapped map = auto_unwrap(surface, {}, options);
    CHECK(density_within(surface, map) == doctest::Approx(share * usual).epsilon(1e-9));
    CHECK(map.result.overlapping.empty());
  }
}

TEST_CASE("inside has no effect where islands are not packed") {
  const Surface surface = ball_in_a_ball();
  AutoUnwrapOptions options;
  options.pack = false;
  const Unwrapped usual = auto_unwrap(surface, {}, options);
  options.inside = 0.5;
  CHECK(auto_unwrap(surface, {}, options).result.corner_uv == usual.result.corner_uv);
}

TEST_CASE("shares that are none are refused") {
  AutoUnwrapOptions options;
  for (const double share :
       {0.0, -0.5, 1.0001, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    options.inside = share;
    try {
      auto_unwrap(uneven_ball(inner), {}, options);
      FAIL_CHECK("it was accepted");
    } catch (const Error& error) {
      CHECK(error.code() == Code::wrong_parameter);
    }
  }
}
