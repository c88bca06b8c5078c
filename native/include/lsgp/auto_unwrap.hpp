// SPDX-License-Identifier: GPL-3.0-or-later
// A finished map in one call: cones, boundaries at creases and divisions of islands, chosen by what maps cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lsgp/completed_cones.hpp"
#include "lsgp/export.hpp"
#include "lsgp/packing.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// What a map is for. With all of them no island overlaps itself.
enum class Preset {
  paint,  // preserves lengths; islands that would leave most of the square empty are cut
  tile,   // seams are invisible for a tileable texture of squares
  bake,   // preserves lengths; islands are cut so that they fill the square, hard surfaces at their creases
};

// What the parts of a map's quality are worth in a choice, in hundredths of L2 stretch. A larger weight is obeyed at
// the cost of the others, 0 is no wish at all.
struct Weights {
  double islands = 0.4;  // each one; a tenth of them where there are more than ten
  double cuts = 0.3;     // those as long as the square root of the surface's area; times their cost where it is above 1
  double borders = 0.3;  // the same at creases, across which the texture does not run on
  double cones = 0.1;    // each one, around which it turns; on a component by the square root of its share of the area
  double square = 1.2;   // as much of the texture as islands fill, left empty
  double strips = 15.0;  // that tubes are laid out as straight strips; by area
  double symmetry = 1.0;  // that cuts run alike on both sides of a mirror plane; half of it, that cones do
};

// What came out of a map. Lengths in square roots of the surface's area.
struct Quality {
  Index left_out = 0;      // triangles without a map
  Index defects = 0;       // flipped and overlapping triangles, and wrong angle sums
  double stretch = 0;      // the excess of L2 stretch over 1, in hundredths
  double islands = 0;      // their number
  double cuts = 0;         // their length
  double costly_cuts = 0;  // what cuts cost beyond their length, by cut_costs above 1 and above those of cheap edges
  double borders = 0;      // theirs
  double cones = 0;        // their number, on several components times the square roots of their shares of the area
  double empty = 0;        // the area of the texture that is left empty, as a multiple of that which is filled
  double bent_tubes = 0;   // the share of the area in tubes that have cones
  double asymmetry = 0;    // 0.5: only cones are alike on both sides of mirror planes; 1: nothing is; by area
  double on_lattice = 0;   // what features off the lattice and small tiles cost, in hundredths of L2 stretch
};

// In hundredths of L2 stretch, but for what is left out and defects, which nothing outweighs.
LSGP_API double cost(const Quality& quality, const Weights& weights);

// A map that was made, or could have been, on the way to a result.
struct Choice {
  std::string name;
  double estimate = 0;             // of its cost; infinite where nothing was known
  std::optional<double> cost;      // none where it was not made
  std::optional<Quality> quality;  // likewise
  std::string reason;              // what came out, or why it was not made
  bool is_best = false;            // of those made until then
};

LSGP_API MapOptions preset_options(Preset preset);
LSGP_API Weights preset_weights(Preset preset);
LSGP_API PackingEffort preset_effort(Preset preset);

struct AutoUnwrapOptions {
  Preset preset = Preset::paint;
  std::optional<MapOptions> map;   // none: those of the preset
  std::optional<Weights> weights;  // none: those of the preset
  std::optional<int> count;        // as in CompletionOptions
  double target = CompletionOptions().target;
  // Cones, and cuts, alike on both sides of a mirror plane where other maps do not cost less. Only without given cones
  // and `count`.
  bool symmetric = true;
  // Charts that marked seams bound get no cones, and no cuts unless they are no disks, where their maps are good
  // without; with SeamMode::exact in any case. And one-sided components are cut open where no cones are given.
  bool charts = true;
  // Hard surfaces may be cut at their creases, and others there and where tubes end if their maps cost less.
  bool creases = true;
  VertexPairs sharp;  // (s, 2) edges that are creases whatever their angle
  // Islands are packed tightly; otherwise they stay side by side, as do those of seamless and pinned maps in any case,
  // and those for whose margins there is no room.
  bool pack = true;
  std::optional<PackingEffort> effort;  // none: that of the preset
  std::optional<double> margin;         // none: usual_margin
  // Of packed islands that nothing outside can see, as by hidden_islands: their texel density relative to that of the
  // others, from the least, below which coordinates have no digits left for them, to 1. Without effect where islands
  // are not packed.
  static constexpr double least_inside = 0.01;
  std::optional<double> inside;
  // After so many the best map made until then is the result, and TIME_LIMIT says so.
  std::optional<double> seconds;
};

struct Unwrapped {
  Result result;
  VertexPairs borders;  // (b, 2) where the surface ends in this map: its own, and those at creases
  std::optional<Placement> placement;
  std::vector<Choice> choices;
  // The islands packed quickly with their usual margin, as they were for the choice; none where no square is filled.
  std::optional<CornerUv> packed_quickly;
};

// cones: are kept. A component without cones gets the number that its stretch requires, which may be 0; one whose cones
// cannot take up its curvature gets more.
// Throws what `place_cones` and `parameterize` throw; WRONG_PARAMETER for weights, targets, seconds and shares that are
// none; TIME_LIMIT where no map was made in time.
LSGP_API Unwrapped auto_unwrap(const Surface& surface, const Cones& cones = {}, const AutoUnwrapOptions& options = {},
                               const Pins& pins = {}, const Progress& progress = {});

}  // namespace lsgp
