// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/coarse_first.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/progress_monitor.hpp"
#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "mesh/large_surface.hpp"
#include "unwrap/simplified_surface.hpp"

namespace lsgp {

namespace {

// Of six smooth and noisy bodies and scans of 70,000 triangles, maps chosen on 10,000 of these have an L2 stretch of up
// to 0.2 hundredths more than maps chosen on all, with noise of 15 % of an edge up to 0.8. Surfaces of 40,000 and
// 90,000 triangles take 0.7 of the time.
constexpr Index few = 10000;
constexpr Index least_reduction = 3;  // where thinning stops earlier, it saves too little
constexpr double choosing = 0.3;      // of the time, on few triangles

// Without what makes a map better that is one already, for when the time is over.
MapOptions made_simply(MapOptions options) {
  options.of_map.compact = Compactness::off;
  options.of_map.mirrored_cuts = false;
  options.of_map.straighten = false;
  return options;
}

}  // namespace

bool is_kept_when_simplified(const Surface& surface, const GivenCones& given, const EndsInMap& ends,
                             const MapOptions& options) {
  if (surface.triangles.rows() < least_large || !given.are_free()) return false;
  const bool has_charts = std::count(given.without.begin(), given.without.end(), 1) > 0;
  const bool has_details = surface.scale.size() > 0 || surface.directions.rows() > 0 || surface.features.rows() > 0;
  return !has_charts && !has_details && ends.tubes.triangles.empty() && !options.of_map.seamless &&
         options.of_map.loop_turning.empty();
}

Made best_coarse_first(const LargeSurface& large, const ChooseMap& choose, Objective& objective,
                       const Progress& progress) {
  const Surface& surface = large.surface;
  const EndsInMap& ends = large.ends;
  const Progress thinning = share_of(progress, 0, 0);
  const SimplifiedSurface simplified = [&] {
    StageSeconds seconds;
    const ProgressMonitor monitor(thinning, seconds);
    return SimplifiedSurface(surface, joined(ends.creases.required, ends.creases.possible), few);
  }();
  const auto count = static_cast<Index>(simplified.surface().triangles.rows());
  const auto chosen_on_whole = [&](const Progress& share) { return choose(surface, ends, objective, share); };
  if (least_reduction * count > surface.triangles.rows()) return chosen_on_whole(progress);
  std::optional<Quality> expected, found;  // with what is chosen on few triangles, there and on all
  Objective on_few(objective.weights(), objective.share());
  const auto on_whole = [&](const MadeMap& best, const MapOptions& how, const Progress& share) {
    const CompletedCones cones = simplified.on_whole(best.cones);
    Surface ending = surface;
    ending.borders = simplified.on_whole(best.surface->surface().borders);
    const Pins no_pins;
    const auto bordered = std::make_shared<BorderedSurface>(std::move(ending), nullptr, nullptr);
    const Made made = maps_of(bordered, no_pins)(cones, how, share);
    tell_findings(*made, how.of_map);
    return made;
  };
  const auto tell_choices = [&] { objective.note_all(concat("on ", count, " triangles"), on_few.choices()); };
  const auto chosen_on_few = [&](const Progress& share) {
    EndsInMap own;
    own.creases = {simplified.from_whole(ends.creases.required), simplified.from_whole(ends.creases.possible),
                   ends.creases.carry_all};
    own.may_cut_open = false;  // that has no counterpart on all triangles
    const Made best = choose(simplified.surface(), own, on_few, share_of(share, 0, choosing));
    expected = on_few.quality(*best, share_of(share, choosing, choosing));
    tell_choices();
    return on_whole(*best, best->options, share_of(share, choosing, 1));
  };
  const auto measure = [&](const Made& made, const Progress& packing) {
    const Quality quality = objective.quality(*made, packing);
    if (!found) found = quality;
    return quality;
  };
  const double most_stretch = 100 * (large.target - 1);
  const auto expected_of_whole = [&]() -> std::optional<double> {
    if (!found || !expected) return Objective::infinity;
    const bool has_defects = found->left_out > 0 || found->defects > expected->defects;
    const bool falls_behind = found->stretch > std::max(most_stretch, expected->stretch);
    if (!has_defects && !falls_behind) return {};
    return cost(*expected, objective.weights());
  };
  try {
    return objective.choose({{"as chosen on few triangles", [] { return 0.0; }, chosen_on_few, measure, {}},
                             {"chosen on all triangles", expected_of_whole, chosen_on_whole, measure, {}}},
                            progress);
  } catch (const Error& error) {
    const Made& best = on_few.best_so_far();
    if (!large.limit.has_caused(error) || objective.best_so_far() || !best) throw;
    const Made made = attempt([&] { return on_whole(*best, made_simply(best->options), large.unlimited); });
    if (!made) throw;
    if (!expected) tell_choices();
    made->result.warnings.push_back(
        {Code::time_limit,
         "The time limit was reached while the map was chosen on few of the triangles: this is the best one until "
         "then, made on all of them after that.",
         {}});
    return made;
  }
}

}  // namespace lsgp
