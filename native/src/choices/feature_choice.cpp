// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/feature_choice.hpp"

#include <algorithm>
#include <utility>

#include "base/number_text.hpp"
#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "completion/features_wanted.hpp"
#include "measures/map_comparison.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// By which a map without creases along the lattice has to be better, where most run along it.
constexpr double worth_of_direction = 0.15;

// Which components have other cones, or other angles of them, in one choice than in the other.
PerComponent<char> have_other_cones(const SurfaceParts& parts, const Cones& one, const Cones& other) {
  using ConeAngle = std::pair<Index, std::optional<double>>;
  const auto in_order = [](const Cones& cones) {
    Array<ConeAngle> out;
    for (std::size_t i = 0; i < cones.vertices.size(); ++i) out.emplace_back(cones.vertices[i], cones.angles[i]);
    sort_unique(out);
    return out;
  };
  const Array<ConeAngle> ones = in_order(one), others = in_order(other);
  Array<ConeAngle> differing;
  std::set_symmetric_difference(ones.begin(), ones.end(), others.begin(), others.end(), std::back_inserter(differing));
  PerComponent<char> out(parts.count(), 0);
  for (const auto& [cone, angle] : differing) {
    if (parts.of_vertex()[cone] != none) out[parts.of_vertex()[cone]] = 1;
  }
  return out;
}

}  // namespace

MapOptions FeatureMaps::unstraightened() const {
  MapOptions out = options_;
  out.of_map.straighten = false;
  return out;
}

// Creases that run along the lattice take most of the time, and stretch the map.
bool FeatureMaps::may_be_worth_it(const CompletedCones& cones, const Progress& progress) const {
  if (!objective_.bounds_whole(parts_)) return true;
  if (objective_.is_beyond_bound(objective_.expected_through(parts_, cones, options_.of_map))) return false;
  const Made plain = attempt([&] { return maps_(cones, unstraightened(), share_of(progress, 0, 0)); });
  return plain && !is_outdone(*plain);
}

Made FeatureMaps::best_on_lattice(const CompletedCones& for_features, SymmetryChoice& others,
                                  const Progress& progress) const {
  const auto third = [&](int number) { return share_of(progress, (number - 1) / 3.0, number / 3.0); };
  Made along;
  if (may_be_worth_it(for_features, third(1))) along = attempt([&] { return through(for_features, third(1)); });
  if (along && !runs_along_features(along->result)) along.reset();
  // Creases along the lattice take time: they are tried with the cones that are chosen. Those that are released run
  // along it through other cones, perhaps.
  const bool is_released = along && releases_features(along->result);
  const Made best = others.best(is_released ? options_ : unstraightened(), third(2));
  if (!best) return along;
  if (!along && is_outdone(*best)) return nullptr;
  if (!along) return through(best->cones, third(3));
  return best_along(along, best, is_released ? UsualFeatures::as_far_as_they_can : UsualFeatures::not_tried, third(3));
}

Made FeatureMaps::best_along(const Made& along, const Made& usual, UsualFeatures features,
                             const Progress& progress) const {
  constexpr double trying = 0.5;  // of the time, with creases
  const PerComponent<char> is_other = have_other_cones(parts_, along->cones.cones, usual->cones.cones);
  PerComponent<char> gains = gains_features(parts_, along->result, usual->result, features);
  const auto gain_of_others = [&] {
    Array<char> out;
    for (Index i = 0; i < parts_.count(); ++i) {
      if (is_other[i]) out.push_back(gains[i]);
    }
    return out;
  };
  const auto all = [](const Array<char>& flags) {
    return std::all_of(flags.begin(), flags.end(), [](char is) { return is; });
  };
  const auto any = [](const Array<char>& flags) {
    return std::any_of(flags.begin(), flags.end(), [](char is) { return is; });
  };
  Made best = usual;
  if (features == UsualFeatures::not_tried && !all(gain_of_others())) {
    // Along creases the usual one is stretched as well.
    best = through(usual->cones, share_of(progress, 0, trying));
    gains = gains_features(parts_, along->result, best->result, UsualFeatures::as_far_as_they_can);
  }
  if (all(gain_of_others())) return along;
  Array<Made> candidates;
  if (any(gain_of_others())) {
    const CompletedCones cones = joined(best->cones, along->cones, parts_.surface(), vertices_on(parts_, gains));
    if (const Made joint = attempt([&] { return through(cones, share_of(progress, trying, 1)); })) {
      candidates.push_back(joint);
    }
  }
  candidates.push_back(along);
  Made chosen;
  for (const Made& candidate : candidates) {
    if (!may_replace_for_features(candidate->result, best->result)) continue;
    if (!chosen || worth_along_features(candidate->result) > worth_along_features(chosen->result)) chosen = candidate;
  }
  const bool is_worth_it = chosen && worth_along_features(chosen->result) >= worth_along_features(best->result);
  return is_worth_it ? chosen : best;
}

Made FeatureMaps::straighter(const CompletedCones& for_features, const Made& usual, const Progress& progress) const {
  if (!releases_features(usual->result)) return usual;
  Made along = attempt([&] { return through(for_features, progress); });
  if (!along || !may_replace_straighter(along->result, usual->result)) return usual;
  tell_findings(*along, options_.of_map);
  return along;
}

Made FeatureMaps::without_creases(const Made& along, const Progress& progress) const {
  const Result& result = along->result;
  if (result.features || !result.seamless || result.seamless->creases.empty() || !releases_features(result)) {
    return along;
  }
  const double share = feature_share(result);
  const double least = worth_along_features(result) + (has_direction(share) ? worth_of_direction : 0);
  Made plain = attempt([&] { return maps_(along->cones, unstraightened(), progress); });
  if (!plain || worth_along_features(plain->result) <= least) return along;
  const std::string message = concat("No creases run along the lattice: only ", decimals(100 * share, 0),
                                     " % of their length can, at an L2 stretch of ",
                                     significant(result.distortion.l2_stretch, 4), " and with tiles that are ",
                                     significant(result.seamless->tile_size / plain->result.seamless->tile_size, 3),
                                     " times as wide. Mark as features those that have to.");
  plain->result.warnings.push_back(
      {Code::features_off_lattice, message, {ElementKind::edges, result.seamless->creases}});
  return plain;
}

Made best_map(const std::shared_ptr<BorderedSurface>& surface, const GivenPlaces& given, const MapOptions& options,
              Objective& objective, const Progress& progress) {
  constexpr double placing_for_features = 0.1;  // of the time
  std::optional<CompletedCones> for_features;
  Progress choosing = progress;
  if (given.cones.are_free() && aligns_features(surface->surface(), options)) {
    for_features = complete_feature_cones(surface->solver, options, given.cones.target,
                                          share_of(progress, 0, placing_for_features));
    choosing = share_of(progress, placing_for_features, 1);
  }
  const MapThrough map = maps_of(surface, given.pins);
  MapOptions tried = options;
  // With defects they cost more than the map that is there, and hard repairs take longer than all else.
  tried.of_map.hard_repairs = options.of_map.hard_repairs && !objective.bounds_defects();
  const FeatureMaps maps(surface->parts, map, tried, std::cref(objective));
  SymmetryChoice cones(*surface, map, given.cones, given.symmetry, objective);
  const Progress untimed = share_of(choosing, 1, 1);
  const bool is_seamless = options.of_map.seamless.has_value();
  Made best =
      is_seamless && for_features ? maps.best_on_lattice(*for_features, cones, choosing) : cones.best(tried, choosing);
  if (!best) return best;
  if (is_seamless) best = maps.without_creases(best, untimed);
  tell_findings(*best, options.of_map);
  return !is_seamless && for_features ? maps.straighter(*for_features, best, untimed) : best;
}

}  // namespace lsgp
