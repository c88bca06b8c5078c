// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/border_choice.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/progress_share.hpp"
#include "choices/border_gain.hpp"
#include "completion/features_wanted.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

constexpr double nearly_all = 0.98;  // of the curvature: what is left is that of slivers and noise
// Components may end at their creases where these carry this share of their curvature, if their map gains by it.
constexpr double least_share_to_try = 0.5;

// The components that do not end at all of their possible borders yet.
Array<Index> components_to_try(const PossibleBorders& possible, const Surface& surface) {
  const EdgeSet present(surface.borders);
  Array<Index> out;
  for (Eigen::Index e = 0; e < possible.edges.rows(); ++e) {
    const bool is_new = !present.has(possible.edges(e, 0), possible.edges(e, 1));
    if (is_new && possible.component[e] != none) out.push_back(possible.component[e]);
  }
  sort_unique(out);
  return out;
}

// The map of the surface that ends at further borders.
using MakeEnding = std::function<Made(const VertexPairs&, const Progress&)>;

// The usual map, or a better one, in which components that gain by their borders end there.
Made best_of_gaining(BorderGain& gain, const PossibleBorders& possible, const Made& usual, const MakeEnding& make,
                     const Progress& progress) {
  // Comparing, and the map of those that gain, where others do not, have no time of their own.
  const Progress begin = share_of(progress, 0, 0), end = share_of(progress, 1, 1);
  Array<Index> chosen = gain.promising(*usual, components_to_try(possible, usual->surface->surface()), begin);
  for (const Progress& stage : {progress, end}) {
    if (chosen.empty()) break;
    const Made found = attempt([&] { return make(possible.of(chosen), stage); });
    if (!found) break;
    Array<Index> gaining = gain.gaining(*found, *usual, chosen);
    if (gaining == chosen) return gain.may_replace(*found, *usual, end) ? found : usual;
    chosen = std::move(gaining);
  }
  return usual;
}

}  // namespace

CreaseBorders crease_borders_for(const Surface& surface, const GivenCones& given, const CreaseRules& rules,
                                 const MapOptions& options, const Progress& progress) {
  CreaseBorders out;
  const bool is_plain = options.of_map.border == BorderMode::free && options.of_map.loop_turning.empty();
  if (!is_plain || options.of_map.seams == SeamMode::exact) return out;
  const Progress untimed = share_of(progress, 0, 0);
  CreaseOptions creases;
  creases.sharp = rules.sharp;
  if (options.of_map.seamless) {
    if (given.are_free() && follows_features(surface, options)) {
      CreaseOptions all = creases;
      all.least_share = nearly_all;
      std::vector<VertexPairs> found = crease_borders_by(surface, {}, {creases, all}, untimed);
      out.possible = std::move(found[0]);
      out.carry_all = out.possible.rows() > 0 && surface.features.rows() == 0 && found[1].rows() == out.possible.rows();
    }
    return out;
  }
  if (!rules.most_corners) return out;
  creases.most_corners = *rules.most_corners;
  std::vector<CreaseOptions> rules_by_need{creases};
  if (!given.count) {
    creases.most_corners = 0;
    creases.least_share = least_share_to_try;
    rules_by_need.push_back(creases);
  }
  std::vector<VertexPairs> found = crease_borders_by(surface, given.cones.vertices, rules_by_need, untimed);
  out.required = std::move(found[0]);
  if (given.count) return out;
  const VertexPairs& possible = found[1];
  const EdgeSet required(out.required);
  out.possible = filtered(possible, [&](Eigen::Index e) { return !required.has(possible(e, 0), possible(e, 1)); });
  return out;
}

Made best_at_creases(BorderedSurfaces& surfaces, const CreaseBorders& creases, const MakeMap& make,
                     Objective& objective, const Progress& progress) {
  const VertexPairs& possible = creases.possible;
  const std::shared_ptr<BorderedSurface> surface = surfaces.first();
  if (possible.rows() == 0) {
    Made best = make(surface, progress);
    tell(progress, 1);
    return best;
  }
  constexpr double trying = 0.5;  // of the time, without further borders
  const Progress rest = share_of(progress, trying, 1);
  Made best, ended;
  {
    std::optional<Objective::Bound> bound;
    if (creases.carry_all) {
      // Without borders there are cones at all corners, which takes far longer. A component that has cones in spite of
      // its borders, or none of them, may be better off without: then each is compared by itself.
      ended = attempt([&] { return make(surfaces.ending_at(possible), share_of(progress, 0, 0)); });
      if (ended && !ended->result.cones.empty()) ended.reset();
      if (ended)
        bound.emplace(objective, objective.quality(*ended, share_of(progress, 0, 0)), Objective::Bound::Of::all);
    }
    try {
      best = make(surface, share_of(progress, 0, trying));
      if (!best) {
        tell(progress, 1);
        return ended;
      }
    } catch (const Error& error) {
      if (error.code() == Code::cancelled) throw;
      if (ended) return ended;
      if (error.code() != Code::solver_failed) throw;
      // Ending at creases it takes fewer cones, or none.
      return make(surfaces.ending_at(possible), rest);
    }
  }
  const PossibleBorders borders(surface->parts, possible);
  const auto make_ending = [&](const VertexPairs& edges, const Progress& share) {
    return ended && edges.rows() == possible.rows() ? ended : make(surfaces.ending_at(edges), share);
  };
  const Objective::Bound bound(objective, objective.quality(*best, share_of(rest, 0, 0)));
  if (best->result.seamless) {
    AlongLattice gain(surface->parts, borders);
    best = best_of_gaining(gain, borders, best, make_ending, rest);
  } else {
    LowerCost gain(surface->parts, borders, at_creases, objective);
    best = best_of_gaining(gain, borders, best, make_ending, rest);
  }
  tell(progress, 1);  // maps that were not needed leave their time
  return best;
}

Made best_around_front(const Made& usual, const VertexPairs& outline, const MakeMap& make, Objective& objective,
                       const Progress& progress) {
  const SurfaceParts& parts = usual->surface->parts;
  const PossibleBorders borders(parts, outline);
  LowerCost gain(parts, borders, around_front, objective);
  const auto make_ending = [&](const VertexPairs& edges, const Progress& share) {
    Surface ending = parts.surface();
    ending.borders = joined(ending.borders, edges);
    return make(std::make_shared<BorderedSurface>(std::move(ending), usual->surface->in_tubes, usual->surface.get()),
                share);
  };
  return best_of_gaining(gain, borders, usual, make_ending, progress);
}

}  // namespace lsgp
