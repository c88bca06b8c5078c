// SPDX-License-Identifier: GPL-3.0-or-later
// Maps that are not made, since their cones alone take them beyond another one.
#include <doctest/doctest.h>

#include "balls.hpp"
#include "choices/symmetry_choice.hpp"

using namespace lsgp;

namespace {

struct Tried {
  Made best;
  int maps = 0;
};

// The choice of usual cones, beside a map without stretch and cuts that costs this much more than nothing.
Tried tried(Surface surface, Objective::Bound::Of of, double more) {
  BorderedSurfaces surfaces(std::move(surface));
  const Pins no_pins;
  const MapThrough maps = maps_of(surfaces.first(), no_pins);
  Tried out;
  const MapThrough counted = [&](const CompletedCones& cones, const MapOptions& options, const Progress& progress) {
    ++out.maps;
    return maps(cones, options, progress);
  };
  Objective objective(preset_weights(Preset::paint), {});
  const GivenCones given;
  Quality rival;
  rival.islands = 1;
  rival.stretch = more;
  const Objective::Bound bound(objective, rival, of);
  SymmetryChoice choice(*surfaces.first(), counted, given, Symmetry::not_tried, objective);
  out.best = choice.best(preset_options(Preset::paint), {});
  return out;
}

constexpr double anything = 1e6;

}  // namespace

TEST_CASE("no map is made where its cones take it beyond a bound of all") {
  const Tried beyond = tried(uneven_ball(2000), Objective::Bound::Of::all, 0);
  CHECK(beyond.best == nullptr);
  CHECK(beyond.maps == 0);
  const Tried within = tried(uneven_ball(2000), Objective::Bound::Of::all, anything);
  CHECK(within.best != nullptr);
  CHECK(within.maps == 1);
}

TEST_CASE("a bound of others leaves the first map") {
  const Tried first = tried(uneven_ball(2000), Objective::Bound::Of::others, 0);
  CHECK(first.best != nullptr);
  CHECK(first.maps == 1);
}

TEST_CASE("of several components one may gain, whatever the cones cost on the others") {
  Surface other = uneven_ball(1000);
  other.positions.col(0).array() += 10;
  const Tried several = tried(merged(uneven_ball(2000), other), Objective::Bound::Of::all, 0);
  CHECK(several.best != nullptr);
  CHECK(several.maps == 1);
}
