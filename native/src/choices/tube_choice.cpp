// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/tube_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "base/progress_share.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// Whether each component has tubes.
PerComponent<char> with_tubes(const SurfaceParts& parts, const Tubes& tubes) {
  PerComponent<char> out(parts.count(), 0);
  for (const Index f : tubes.triangles) {
    if (parts.of_triangle()[f] != none) out[parts.of_triangle()[f]] = 1;
  }
  return out;
}

// Those of some edges that are on components without tubes.
VertexPairs beside_tubes(const VertexPairs& edges, const SurfaceParts& parts, const PerComponent<char>& has_tubes) {
  return filtered(edges, [&](Eigen::Index e) {
    const Index f = parts.triangle_at(edges(e, 0), edges(e, 1));
    return f == none || parts.of_triangle()[f] == none || !has_tubes[parts.of_triangle()[f]];
  });
}

// Those that seams open, which end nowhere else.
void keep_opened(const Surface& surface, Tubes& tubes) {
  if (tubes.triangles.empty()) return;
  const SurfaceParts parts{std::cref(surface)};
  const PerComponent<char> has_seams = have_edges(parts, parts.surface().seams);
  const auto is_other = [&](Index f) { return parts.of_triangle()[f] == none || !has_seams[parts.of_triangle()[f]]; };
  std::vector<Index>& own = tubes.triangles;
  own.erase(std::remove_if(own.begin(), own.end(), is_other), own.end());
  tubes.borders.resize(0, 2);
}

// Of the area, what is in tubes.
double share_of_tubes(const SurfaceParts& parts, const Tubes& tubes) {
  double area = 0;
  for (const Index f : tubes.triangles) area += parts.triangle_areas()[f];
  return parts.area() > 0 ? area / parts.area() : 0;
}

// What another map can save at most that differs on the components with tubes alone.
double most_saved(const SurfaceParts& parts, const PerComponent<char>& has_tubes, MadeMap& made, Objective& objective) {
  const Weights& weights = objective.weights();
  const PerComponent<double> costs = costs_on(parts, made, weights).whole;
  const Quality quality = objective.quality(made, {});
  double out = weights.strips * quality.bent_tubes;
  for (Index i = 0; i < parts.count(); ++i) {
    if (has_tubes[i]) out += costs[i] + weights.square * quality.empty * parts.areas()[i] / parts.area();
  }
  return out;
}

// What a map costs at least that ends at these borders and has no stretch: an island for each piece.
double least_cost(const BorderedSurfaces& surfaces, const Weights& weights) {
  const SurfaceParts& parts = surfaces.first()->parts;
  Quality least;
  least.islands = parts.count();
  least.borders = parts.area() > 0 ? length_of(parts.surface(), parts.surface().borders) / std::sqrt(parts.area()) : 0;
  return cost(least, weights);
}

}  // namespace

Tubes tubes_for(const Surface& surface, const GivenCones& given, const MapOptions& options, const Pins& pins,
                const Progress& progress) {
  if (options.of_map.seamless) return {};
  const bool is_plain = options.of_map.border == BorderMode::free && options.of_map.loop_turning.empty();
  if (!is_plain || given.count || !pins.corners.empty()) return {};
  Tubes out = find_tubes(surface, given.cones.vertices, share_of(progress, 0, 0));
  if (options.of_map.seams == SeamMode::exact) keep_opened(surface, out);
  return out;
}

Made best_of_tubes(const Surface& surface, const EndsOfSurface& ends, const MakeWithTubes& make, Objective& objective,
                   const Progress& progress) {
  const CreaseBorders& creases = ends.creases;
  const Tubes& tubes = ends.tubes;
  std::shared_ptr<PerTriangle<char>> in_tubes;
  if (!tubes.triangles.empty()) in_tubes = std::make_shared<PerTriangle<char>>(surface.triangles.rows(), 0);
  for (const Index f : tubes.triangles) (*in_tubes)[f] = 1;
  const auto ending_at = [&](const VertexPairs& borders) {
    Surface ending = surface;
    ending.borders = joined(ending.borders, borders);
    return BorderedSurfaces(std::move(ending), in_tubes);
  };
  const auto best = [&](BorderedSurfaces& surfaces, const CreaseBorders& possible, TubesBecome what,
                        const Progress& share) {
    const auto make_one = [&](const std::shared_ptr<BorderedSurface>& bordered, const Progress& of_one) {
      return make(bordered, what, of_one);
    };
    return best_at_creases(surfaces, possible, make_one, objective, share);
  };
  BorderedSurfaces usual = ending_at(creases.required);
  const SurfaceParts& parts = usual.first()->parts;
  if (tubes.triangles.empty()) return best(usual, creases, TubesBecome::anything, progress);
  const PerComponent<char> has_tubes = with_tubes(parts, tubes);
  BorderedSurfaces unrolled = ending_at(joined(beside_tubes(creases.required, parts, has_tubes), tubes.borders));
  const CreaseBorders others{{}, beside_tubes(creases.possible, parts, has_tubes)};
  const auto quality = [&](const Made& made, const Progress& share) { return objective.quality(*made, share); };
  const double bent = objective.weights().strips * share_of_tubes(parts, tubes);
  Made first;  // of the two, once it is made
  const auto expected = [&](double least) -> std::optional<double> {
    const bool can_gain = !first || most_saved(parts, has_tubes, *first, objective) > error_of_estimates;
    return can_gain ? std::optional<double>(least) : std::nullopt;
  };
  const auto made = [&](const auto& make_one) { return first = make_one(); };
  std::vector<Candidate> candidates;
  candidates.push_back(
      {"tubes as strips",
       [&] { return expected(least_cost(unrolled, objective.weights())); },
       [&](const Progress& share) { return made([&] { return best(unrolled, others, TubesBecome::strips, share); }); },
       quality,
       {}});
  candidates.push_back(
      {"tubes as they are",
       [&] { return expected(bent + least_cost(usual, objective.weights())); },
       [&](const Progress& share) { return made([&] { return best(usual, creases, TubesBecome::anything, share); }); },
       quality,
       {}});
  return objective.choose(std::move(candidates), progress);
}

}  // namespace lsgp
