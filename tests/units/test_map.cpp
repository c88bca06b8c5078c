// SPDX-License-Identifier: GPL-3.0-or-later
// A whole map, which the factorization that is linked must carry.
#include <doctest/doctest.h>

#include <cmath>

#include "balls.hpp"
#include "lsgp/lsgp.hpp"

namespace {

// A torus, whose map needs the Schur complement of its cuts.
lsgp::Surface ring(int around, int about) {
  lsgp::Surface out;
  out.positions.resize(around * about, 3);
  out.triangles.resize(2 * around * about, 3);
  out.seams.resize(0, 2);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < about; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / about, radius = 2 + std::cos(v);
      out.positions.row(i * about + j) << radius * std::cos(u), radius * std::sin(u), std::sin(v);
      const int k = (i + 1) % around, l = (j + 1) % about;
      const int a = i * about + j, b = k * about + j, c = k * about + l, d = i * about + l;
      out.triangles.row(2 * a) << a, b, c;
      out.triangles.row(2 * a + 1) << a, c, d;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a map has the sides of its cuts related by rotations and translations") {
  const lsgp::Surface surface = ring(24, 12);
  const lsgp::Cones cones{{0, 100, 200, 6}, {2.5 * M_PI, 1.5 * M_PI, 2.25 * M_PI, 1.75 * M_PI}};
  for (const auto factorization : {lsgp::Factorization::cut, lsgp::Factorization::sparse}) {
    lsgp::Options options;
    options.factorization = factorization;
    const lsgp::Result result = lsgp::parameterize(surface, cones, options);
    CHECK(result.corner_uv.allFinite());
    const lsgp::Measurement measured = lsgp::measure_distortion(surface, result.corner_uv, &cones.vertices);
    CHECK(measured.seams.sister_ratio_max < 1 + 1e-9);
    CHECK(measured.flipped.empty());
  }
}

TEST_CASE("without hard repairs a map is that with all of them, or has more defects") {
  const lsgp::Surface ball = lsgp::uneven_ball(300);
  const auto defects = [](const lsgp::Result& map) { return map.flipped.size() + map.wrong_angle_sums.size(); };
  int saved = 0;  // steps of Newton's method
  for (lsgp::Index at = 0; at < 100; at += 20) {
    // Next to each other.
    const lsgp::Cones cones{{at, at + 1, at + 2}, {0.3 * M_PI, 0.3 * M_PI, 1.4 * M_PI}};
    lsgp::Options options;
    const lsgp::Result all = lsgp::parameterize(ball, cones, options);
    options.hard_repairs = false;
    const lsgp::Result easy = lsgp::parameterize(ball, cones, options);
    CHECK(defects(all) == 0);
    const bool is_same = easy.corner_uv == all.corner_uv;
    CHECK((is_same || defects(easy) > 0));
    CHECK(easy.repair.iterations <= all.repair.iterations);
    saved += all.repair.iterations - easy.repair.iterations;
  }
  CHECK(saved > 0);
}
