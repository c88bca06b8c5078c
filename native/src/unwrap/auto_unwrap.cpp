// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/auto_unwrap.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "choices/division_choice.hpp"
#include "choices/feature_choice.hpp"
#include "choices/front_choice.hpp"
#include "choices/marked_seams.hpp"
#include "choices/one_sided_parts.hpp"
#include "choices/tube_choice.hpp"
#include "choices/unfolded_parts.hpp"
#include "completion/features_wanted.hpp"
#include "lsgp/lsgp.hpp"
#include "measures/map_comparison.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "unwrap/canonical_surface.hpp"
#include "unwrap/coarse_first.hpp"
#include "unwrap/presets.hpp"
#include "unwrap/time_limit.hpp"

namespace lsgp {

namespace {

void require_valid(const Weights& weights, const AutoUnwrapOptions& options) {
  const std::array named{std::pair("islands", weights.islands),  std::pair("cuts", weights.cuts),
                         std::pair("borders", weights.borders),  std::pair("cones", weights.cones),
                         std::pair("square", weights.square),    std::pair("strips", weights.strips),
                         std::pair("symmetry", weights.symmetry)};
  for (const auto& [name, weight] : named) {
    if (std::isfinite(weight) && weight >= 0) continue;
    throw Error(Code::wrong_parameter,
                concat("weights.", name, " is ", weight, "; pass a finite number that is not negative."));
  }
  const double target = options.target;
  if (!std::isfinite(target) || target <= 1) {
    throw Error(Code::wrong_parameter, concat("target is ", target, "; pass an L2 stretch, a finite number above 1."));
  }
  if (options.inside && !(*options.inside >= AutoUnwrapOptions::least_inside && *options.inside <= 1)) {
    throw Error(Code::wrong_parameter, concat("inside is ", *options.inside, "; pass a number from ",
                                              AutoUnwrapOptions::least_inside, " to 1."));
  }
  if (options.seconds && !(*options.seconds > 0)) {
    throw Error(Code::wrong_parameter, concat("seconds is ", *options.seconds, "; pass a positive number."));
  }
}

// The map with angles of least distortion, or one that follows the surface's strokes where it gains by that.
Made best_for_strokes(const Surface& surface, const MapOptions& options,
                      const std::function<Made(const MapOptions&, const Progress&)>& mapped, const Progress& progress) {
  if (!options.of_map.follow_strokes || !has_strokes(surface)) return mapped(options, progress);
  constexpr double trying = 0.5;  // of the time, without strokes
  MapOptions others = options;
  others.of_map.follow_strokes = false;
  Made usual = mapped(others, share_of(progress, 0, trying));
  if (direction_error(usual->result) > least_direction_error) {
    const Made toward = attempt([&] { return mapped(options, share_of(progress, trying, 1)); });
    if (toward && follows_strokes_better(toward->result, usual->result)) return toward;
  }
  tell(progress, 1);
  return usual;
}

// Scales islands that nothing outside can see.
void scale_hidden(const Surface& surface, double scale, Result& result, const Progress& progress) {
  Array<char> is_hidden(result.island.size(), 0);  // of islands, of which there are no more than triangles
  for (const Index island : hidden_islands(surface, result.island, progress)) is_hidden[island] = 1;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    const Index island = element(result.island, f);
    if (island >= 0 && is_hidden[island]) result.corner_uv.middleRows<3>(Eigen::Index{3} * f) *= scale;
  }
}

// Packs the islands of a map, unless its margins leave no room.
// packed_quickly: as for pack_islands.
void pack(Result& result, std::optional<double> margin, PackingEffort effort, const CornerUv* packed_quickly,
          const Progress& progress) try {
  PackingOptions options;
  options.margin = margin ? *margin : usual_margin(result.corner_uv, result.island);
  options.turns = turns_of(result);
  options.effort = effort;
  result.corner_uv = pack_islands(result.corner_uv, result.island, options, progress, packed_quickly);
} catch (const Error& error) {
  if (error_kind(error.code()) != ErrorKind::input) throw;
  tell(progress, 1);
}

// What `make` returns, or when the time is over the best map of the objective until then.
Made best_in_time(const TimeLimit& limit, const Objective& objective, const MapOptions& of_map,
                  const std::function<Made()>& make) try {
  return make();
} catch (const Error& error) {
  const Made& best = objective.best_so_far();
  if (!limit.has_caused(error) || !best) throw;
  tell_findings(*best, of_map.of_map);
  tell_stretched_strips(*best);
  best->result.warnings.push_back(
      {Code::time_limit, "The time limit was reached: this is the best map made until then.", {}});
  return best;
}

struct GivenForMap {
  const Surface& surface;
  const Cones& cones;
  const Pins& pins;
};

Unwrapped unwrapped(const GivenForMap& from, const AutoUnwrapOptions& options, const TimeLimit& limit) {
  const Cones& cones = from.cones;
  const Pins& pins = from.pins;
  const Progress& progress = limit.progress();
  const PresetRow preset = row_of(options.preset);
  const Weights weights = options.weights.value_or(preset.weights);
  constexpr double measuring = 0.1;  // of the time, where seams are marked
  const MapOptions wanted = options.map.value_or(preset_options(options.preset));
  const GivenCones to_keep{cones, options.count, options.target, {}};
  OpenedParts opened;
  std::optional<Surface> two_sided;
  if (options.charts && to_keep.are_free() && wanted.of_map.seams != SeamMode::exact && pins.corners.empty()) {
    opened = ends_of_one_sided_parts(from.surface);
  }
  if (!opened.triangles.empty()) {
    two_sided = from.surface;
    two_sided->borders = joined(two_sided->borders, opened.ends);
  }
  const Surface& whole = two_sided ? *two_sided : from.surface;
  const bool has_charts = options.charts || wanted.of_map.seams == SeamMode::exact;
  const AlongSeams along = has_charts ? along_seams(whole, to_keep, wanted, share_of(progress, 0, measuring))
                                      : AlongSeams{whole, to_keep, wanted, {}};
  const Surface& surface = along.surface;
  const GivenCones& given = along.given;
  const MapOptions& of_map = along.options;
  const bool is_measured = has_charts && whole.seams.rows() > 0;
  const auto after_measuring = [&](const Progress& whole_time) {
    return is_measured ? share_of(whole_time, measuring, 1) : whole_time;
  };
  const Progress choosing = after_measuring(progress);
  EndsInMap ends;
  if (options.creases) {
    ends.creases =
        crease_borders_for(surface, given, {preset.most_corners, options.sharp}, of_map, share_of(choosing, 0, 0));
  }
  const bool is_pinned = !pins.corners.empty();
  if (is_pinned) ends.creases.possible.resize(0, 2);
  const bool is_packed = options.pack && !is_pinned && !of_map.of_map.seamless;
  constexpr double mapping = 0.9;  // of the time, where islands are packed afterward
  const Progress of_maps = share_of(choosing, 0, is_packed ? mapping : 1);
  if (options.creases && weights.strips > 0 && !is_pinned) {
    ends.tubes = tubes_for(surface, given, ends.creases, of_map, share_of(choosing, 0, 0));
  }
  if (options.creases && !is_pinned) ends.outline = outline_for(surface, given, of_map, share_of(choosing, 0, 0));
  Objective objective(weights, {of_map.of_map.square_share});
  const Symmetry symmetry = options.symmetric && !options.count ? Symmetry::tried : Symmetry::not_tried;
  const ChooseMap choose = [&](const Surface& on, const EndsInMap& its_ends, Objective& by, const Progress& share) {
    const auto mapped = [&](const MapOptions& chosen, const Progress& of_maps_alone) {
      const auto make = [&](const std::shared_ptr<BorderedSurface>& bordered, TubesBecome what,
                            const Progress& of_one) {
        MapOptions with = chosen;
        if (what == TubesBecome::strips) with.of_map.border = BorderMode::strips;
        return best_map(bordered, {given, symmetry, pins}, with, by, of_one);
      };
      return best_of_tubes(on, {its_ends.creases, its_ends.tubes}, make, by, of_maps_alone);
    };
    Made usual = best_for_strokes(on, of_map, mapped, share);
    if (is_pinned) return usual;
    const bool may_end = given.are_free() && of_map.of_map.seams != SeamMode::exact && its_ends.may_cut_open;
    const Made whole = may_end ? with_unfolded_parts(usual, of_map, by, share_of(share, 1, 1)) : usual;
    const Made around = best_of_front(whole, its_ends.outline, given.target, by, share_of(share, 1, 1));
    const Made divided = best_division(around, of_map, by, share);
    tell_stretched_strips(*divided);
    return divided;
  };
  const Progress late = share_of(after_measuring(limit.unlimited()), is_packed ? mapping : 1, is_packed ? mapping : 1);
  const Made best = best_in_time(limit, objective, of_map, [&] {
    const bool may_be_simplified = is_kept_when_simplified(surface, given, ends, of_map) && !is_pinned;
    return may_be_simplified
               ? best_coarse_first({surface, ends, options.target, limit, late}, choose, objective, of_maps)
               : choose(surface, ends, objective, of_maps);
  });

  Unwrapped out{std::move(best->result), best->surface->surface().borders, std::move(best->cones.placement),
                objective.choices(), std::move(best->packed_quickly)};
  tell_further_cuts(along.further, out.result);
  tell_opened(opened, out.result);
  if (is_packed) {
    constexpr double looking = 0.3;  // of the time of packing
    const Progress last = share_of(after_measuring(limit.unlimited()), mapping, 1);
    if (options.inside) scale_hidden(whole, *options.inside, out.result, share_of(last, 0, looking));
    const PackingEffort effort = limit.is_over() ? PackingEffort::quick : options.effort.value_or(preset.effort);
    const Progress packing = options.inside ? share_of(last, looking, 1) : last;
    const CornerUv* const known =
        out.packed_quickly && !options.margin && !options.inside ? &*out.packed_quickly : nullptr;
    pack(out.result, options.margin, effort, known, packing);
  }
  return out;
}

CanonicalSurface canonical_surface(const Surface& surface) try {
  return CanonicalSurface(surface);
} catch (const Error& error) {
  throw in_words(error);
}

Unwrapped unwrapped_as(const CanonicalSurface& canonical, const Cones& cones, const AutoUnwrapOptions& options,
                       const TimeLimit& limit) try {
  const Cones own = canonical.of(cones);
  const Pins no_pins;
  Unwrapped out = unwrapped({canonical.surface(), own, no_pins}, canonical.of(options), limit);
  canonical.restore(cones, out);
  return out;
} catch (const Error& error) {
  throw canonical.restored(error);
}

}  // namespace

Unwrapped auto_unwrap(const Surface& surface, const Cones& cones, const AutoUnwrapOptions& options, const Pins& pins,
                      const Progress& progress) {
  const TimeLimit limit(options.seconds, progress);
  require_valid(surface);
  require_vertices(surface, cones);
  require_valid(options.weights.value_or(row_of(options.preset).weights), options);
  require_vertices(surface, options.sharp, "sharp edges");
  if (options.map) require_valid(options.map->of_map);
  const bool is_pinned = !pins.corners.empty() || pins.positions.rows() > 0;
  try {
    if (is_pinned) return unwrapped({surface, cones, pins}, options, limit);
    const CanonicalSurface canonical = canonical_surface(surface);
    return unwrapped_as(canonical, cones, options, limit);
  } catch (const Error& error) {
    if (!limit.has_caused(error)) throw;
    throw Error(Code::time_limit,
                "No map was made within the time limit. Allow more time, or unwrap fewer faces at once.");
  }
}

}  // namespace lsgp
