// SPDX-License-Identifier: GPL-3.0-or-later
// Choices on few triangles of a large surface, and what comes of them on all of them.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "lsgp/lsgp.hpp"
#include "unwrap/coarse_first.hpp"
#include "unwrap/simplified_surface.hpp"

using namespace lsgp;

namespace {

// A smooth ball of about so many triangles without symmetry.
Surface ball(Index triangles) {
  const auto rows = static_cast<Index>(std::sqrt(triangles / 4.0)), around = 2 * rows;
  Surface out;
  out.positions.resize(around * (rows - 1) + 2, 3);
  const auto place = [&](Index v, double latitude, double longitude) {
    const double z = std::sin(latitude), x = std::cos(latitude) * std::cos(longitude),
                 y = std::cos(latitude) * std::sin(longitude);
    const double radius = 1 + 0.2 * std::sin(2.3 * x + 1) * std::cos(1.7 * y) + 0.1 * std::sin(3.1 * z + y);
    out.positions.row(v) << radius * x, radius * y, radius * z;
  };
  for (Index i = 0; i < rows - 1; ++i) {
    for (Index j = 0; j < around; ++j) {
      place(around * i + j, M_PI * (i + 1) / rows - M_PI / 2, 2 * M_PI * j / around);
    }
  }
  const Index south = around * (rows - 1), north = south + 1;
  place(south, -M_PI / 2, 0);
  place(north, M_PI / 2, 0);
  std::vector<Index> corners;
  for (Index j = 0; j < around; ++j) {
    const Index next = (j + 1) % around, last = around * (rows - 2);
    corners.insert(corners.end(), {south, next, j, north, last + j, last + next});
    for (Index i = 0; i + 2 < rows; ++i) {
      const Index a = around * i + j, b = around * i + next, c = b + around, d = a + around;
      corners.insert(corners.end(), {a, b, c, a, c, d});
    }
  }
  out.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Index>(corners.size()) / 3, 3);
  return out;
}

// What the best map is chosen by: these cones on few triangles, the usual ones on all.
struct Chooser {
  const Surface& whole;
  bool with_cones;
  int on_few = 0, on_all = 0;

  Made operator()(const Surface& on, const EndsInMap&, Objective&, const Progress&) {
    const bool is_whole = on.triangles.rows() == whole.triangles.rows();
    ++(is_whole ? on_all : on_few);
    const auto surface = std::make_shared<BorderedSurface>(on, nullptr, nullptr);
    const MapOptions options = preset_options(Preset::paint);
    Made made = maps_of(surface, pins)(complete_cones(surface->solver, {}, {}, options), options, {});
    if (!is_whole && !with_cones) made->cones = {};
    return made;
  }

  const Pins pins{};
};

Made chosen(const Surface& surface, Chooser& chooser) {
  Objective objective(preset_weights(Preset::paint), {});
  const EndsInMap nowhere;
  const Progress untold;
  const TimeLimit none({}, untold);
  return best_coarse_first({surface, nowhere, 1.05, none, untold}, std::ref(chooser), objective, untold);
}

}  // namespace

TEST_CASE("what is chosen on few triangles is made on all of them") {
  const Surface surface = ball(33000);
  Chooser chooser{surface, true};
  const Made made = chosen(surface, chooser);
  CHECK(chooser.on_few == 1);
  CHECK(chooser.on_all == 0);
  CHECK(made->surface->surface().triangles.rows() == surface.triangles.rows());
  CHECK(made->result.flipped.empty());
  CHECK(made->result.cones.size() == made->cones.cones.vertices.size());
  CHECK(made->result.distortion.l2_stretch < 1.05);
  REQUIRE(made->cones.placement);
  CHECK(made->cones.placement->log_scale.size() == surface.positions.rows());
}

TEST_CASE("where that cannot be made, the map is chosen on all triangles") {
  const Surface surface = ball(33000);
  Chooser chooser{surface, false};  // a ball has no map without cones
  const Made made = chosen(surface, chooser);
  CHECK(chooser.on_few == 1);
  CHECK(chooser.on_all == 1);
  CHECK(made->result.cones.size() > 2);
}

TEST_CASE("what a simplified surface keeps has the same places on the whole one") {
  Surface surface = ball(5000);
  surface.borders.resize(3, 2);
  surface.borders << 500, 501, 501, 502, 502, 503;
  surface.importance = Eigen::VectorXd::LinSpaced(surface.positions.rows(), 1, 2);
  VertexPairs kept(1, 2);
  kept << 900, 901;
  const SimplifiedSurface simplified(surface, kept, 600);
  const Surface& small = simplified.surface();
  CHECK(small.triangles.rows() < 800);
  CHECK(simplified.on_whole(small.borders) == surface.borders);
  CHECK(simplified.on_whole(simplified.from_whole(kept)) == kept);
  VertexPairs all(small.positions.rows(), 2);
  for (Index v = 0; v < all.rows(); ++v) all.row(v) << v, v;
  all = simplified.on_whole(all);
  for (Index v = 0; v < all.rows(); ++v) {
    CHECK(small.positions.row(v) == surface.positions.row(all(v, 0)));
    CHECK(small.importance[v] == surface.importance[all(v, 0)]);
  }
}

TEST_CASE("a linear function on a simplified surface is linear on the whole one, up to its bending") {
  const Surface surface = ball(5000);
  const SimplifiedSurface simplified(surface, {}, 1500);
  CompletedCones cones;
  cones.placement = Placement{};
  cones.placement->log_scale = simplified.surface().positions.col(2);
  const Eigen::VectorXd carried = simplified.on_whole(std::move(cones)).placement->log_scale;
  CHECK((carried - surface.positions.col(2)).cwiseAbs().maxCoeff() < 0.1);
}
