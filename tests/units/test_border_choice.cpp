// SPDX-License-Identifier: GPL-3.0-or-later
// Components end at creases where their maps gain by it.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "choices/border_choice.hpp"
#include "choices/border_gain.hpp"

using namespace lsgp;

namespace {

Surface tetrahedron() {
  Surface out;
  out.positions.resize(4, 3);
  out.positions << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  out.triangles.resize(4, 3);
  out.triangles << 0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2;
  return out;
}

// Three sides around a vertex.
VertexPairs corner() {
  VertexPairs out(3, 2);
  out << 0, 1, 0, 2, 0, 3;
  return out;
}

// A map without distortion, of so many islands, that fills this part of the square.
MadeMap map_of(const std::shared_ptr<BorderedSurface>& surface, double islands, double filled) {
  MadeMap out;
  out.surface = surface;
  out.result.island.assign(4, 0);
  out.quality = Quality{};
  out.quality->islands = islands;
  out.quality->empty = 1 / filled - 1;
  return out;
}

}  // namespace

TEST_CASE("a fuller square is worth as many islands as weights say") {
  BorderedSurfaces surfaces(tetrahedron());
  const PossibleBorders possible(surfaces.first()->parts, corner());
  for (const Preset preset : {Preset::paint, Preset::bake}) {
    const Weights weights = preset_weights(preset);
    Objective objective(weights, {});
    LowerCost gain(surfaces.first()->parts, possible, at_creases, objective);
    for (const double more : {0.0, 1.0, 3.0}) {
      // The square that makes up for the further islands.
      const double even = 1 / (1 + weights.islands * more / weights.square);
      MadeMap whole = map_of(surfaces.first(), 2 + more, 1);
      MadeMap emptier = map_of(surfaces.first(), 2, 0.99 * even);
      CHECK(gain.may_replace(whole, emptier, {}));
      MadeMap fuller = map_of(surfaces.first(), 2, std::min(1.0, 1.01 * even));
      CHECK_FALSE(gain.may_replace(whole, fuller, {}));
      whole.result.flipped = {3};
      CHECK_FALSE(gain.may_replace(whole, emptier, {}));
    }
  }
}

TEST_CASE("progress ends at one where the map with borders fails") {
  BorderedSurfaces surfaces(tetrahedron());
  const Pins no_pins;
  // A tetrahedron unfolds exactly through its cones: boundaries cost nothing, so that they may do as well.
  Weights weights;
  weights.islands = weights.borders = weights.square = 0;
  Objective objective(weights, {});
  std::vector<double> told;
  int maps = 0;
  const auto make = [&](const std::shared_ptr<BorderedSurface>& surface, const Progress& progress) {
    if (++maps > 1) throw Error(Code::angles_impossible, "There are none.");
    CompletedCones cones;
    cones.cones = {{0, 1, 2, 3}, {{}, {}, {}, {}}};
    return maps_of(surface, no_pins)(cones, {}, progress);
  };
  const Made best = best_at_creases(surfaces, {{}, corner()}, make, objective, [&](double done) {
    told.push_back(done);
    return true;
  });
  CHECK(maps == 2);
  CHECK(best->surface == surfaces.first());
  CHECK(told.back() == 1);
  CHECK(std::is_sorted(told.begin(), told.end()));
}

TEST_CASE("components end at all their creases where there is no map without") {
  BorderedSurfaces surfaces(tetrahedron());
  const Pins no_pins;
  Objective objective({}, {});
  const auto make = [&](const std::shared_ptr<BorderedSurface>& surface, const Progress& progress) {
    if (surface == surfaces.first()) throw Error(Code::solver_failed, "It failed.");
    return maps_of(surface, no_pins)({}, {}, progress);
  };
  const Made best = best_at_creases(surfaces, {{}, corner()}, make, objective, {});
  CHECK(best->surface->surface().borders == corner());
}

TEST_CASE("where creases carry all curvature the map that ends there is made first, and once") {
  BorderedSurfaces surfaces(tetrahedron());
  const Pins no_pins;
  Objective objective({}, {});
  std::vector<bool> ends;
  const auto make = [&](const std::shared_ptr<BorderedSurface>& surface, const Progress& progress) {
    ends.push_back(surface != surfaces.first());
    if (!ends.back()) throw Error(Code::angles_impossible, "There are none.");
    return maps_of(surface, no_pins)({}, {}, progress);
  };
  const Made best = best_at_creases(surfaces, {{}, corner(), true}, make, objective, {});
  CHECK(best->surface->surface().borders == corner());
  CHECK(ends == std::vector<bool>{true, false});
}
