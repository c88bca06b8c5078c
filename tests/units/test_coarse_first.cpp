// SPDX-License-Identifier: GPL-3.0-or-later
// Choices on few triangles of a large surface, and what comes of them on all of them.
#include <doctest/doctest.h>

#include <vector>

#include "balls.hpp"
#include "lsgp/lsgp.hpp"
#include "unwrap/coarse_first.hpp"
#include "unwrap/simplified_surface.hpp"

using namespace lsgp;

namespace {

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

enum class Stop { before, after_a_map };

constexpr const char* stopped = "It was stopped.";

// The limit, whose time is over, is asked from that moment of the choice on few triangles on.
Made chosen_in_time(const Surface& surface, const TimeLimit& limit, Stop when) {
  bool is_asked = false;
  const Progress progress = [&](double done) { return !is_asked || limit.progress()(done); };
  Chooser chooser{surface, true};
  const auto choose = [&](const Surface& on, const EndsInMap& ends, Objective& by, const Progress& share) {
    if (when == Stop::after_a_map) {
      const auto make = [&](const Progress& of_map) { return chooser(on, ends, by, of_map); };
      const auto quality = [&](const Made& made, const Progress& packing) { return by.quality(*made, packing); };
      by.choose({{"a map", [] { return 0.0; }, make, quality, {}}}, share);
    }
    is_asked = true;
    if (share && !share(1)) throw Error(Code::cancelled, stopped);
    return chooser(on, ends, by, share);
  };
  Objective objective(preset_weights(Preset::paint), {});
  const EndsInMap nowhere;
  return best_coarse_first({surface, nowhere, 1.05, limit, limit.unlimited()}, choose, objective, progress);
}

}  // namespace

TEST_CASE("what is chosen on few triangles is made on all of them") {
  const Surface surface = uneven_ball(33000);
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
  const Surface surface = uneven_ball(33000);
  Chooser chooser{surface, false};  // a ball has no map without cones
  const Made made = chosen(surface, chooser);
  CHECK(chooser.on_few == 1);
  CHECK(chooser.on_all == 1);
  CHECK(made->result.cones.size() > 2);
}

TEST_CASE("what a simplified surface keeps has the same places on the whole one") {
  Surface surface = uneven_ball(5000);
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
  const Surface surface = uneven_ball(5000);
  const SimplifiedSurface simplified(surface, {}, 1500);
  CompletedCones cones;
  cones.placement = Placement{};
  cones.placement->log_scale = simplified.surface().positions.col(2);
  const Eigen::VectorXd carried = simplified.on_whole(std::move(cones)).placement->log_scale;
  CHECK((carried - surface.positions.col(2)).cwiseAbs().maxCoeff() < 0.1);
}

TEST_CASE("when the time is over, what was chosen on few triangles until then is made on all of them") {
  const Surface surface = uneven_ball(33000);
  const TimeLimit limit(0.0, {});
  const Made made = chosen_in_time(surface, limit, Stop::after_a_map);
  CHECK(made->surface->surface().triangles.rows() == surface.triangles.rows());
  CHECK(made->result.flipped.empty());
  CHECK(made->result.warnings.back().code == Code::time_limit);
}

TEST_CASE("nothing is delivered where nothing was chosen in time, and after a cancel") {
  const Surface surface = uneven_ball(33000);
  const TimeLimit limit(0.0, {}), cancelled(0.0, [](double) { return false; });
  CHECK_THROWS_WITH(chosen_in_time(surface, limit, Stop::before), stopped);
  CHECK_THROWS_WITH(chosen_in_time(surface, cancelled, Stop::after_a_map), stopped);
}
