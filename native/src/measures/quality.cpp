// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "measures/map_comparison.hpp"
#include "measures/triangle_measures.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// Up to so many islands each counts in full, of more of them what makes the tenth part.
constexpr double few_islands = 10;
// Of tubes that unfold as they are: pipes, cones and prisms.
constexpr double most_l2_of_plain = 1.001;

// What cuts cost beyond their length; nothing in seamless layouts, whose cuts do not show.
PerComponent<double> extra_costs(const SurfaceParts& parts, const Result& result) {
  if (result.seamless) return PerComponent<double>(parts.count(), 0);
  return extra_costs_on(parts, result.cut_edges);
}

double area_of(const Result& result, const CornerUv& corner_uv) {
  double sum = 0;
  for (std::size_t f = 0; f < result.island.size(); ++f) {
    if (result.island[f] >= 0) sum += uv_area(corner_uv, static_cast<Index>(f));
  }
  return sum;
}

// The islands in the unit square; none if they cannot be packed.
std::optional<CornerUv> packed_quickly(const Result& result, const Progress& progress) try {
  PackingOptions options;
  options.turns = turns_of(result);
  options.effort = PackingEffort::quick;
  options.margin = usual_margin(result.corner_uv, result.island);
  return pack_islands(result.corner_uv, result.island, options, progress);
} catch (const Error& error) {
  if (error_kind(error.code()) != ErrorKind::input) throw;
  return {};
}

// The part of all their boxes that islands fill.
double filled_boxes(const Result& result) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Index count = 1 + *std::max_element(result.island.begin(), result.island.end());
  Array<Eigen::Vector2d> least(count, Eigen::Vector2d::Constant(infinity)), largest(count, -least[0]);
  for (Index c = 0; c < result.corner_uv.rows(); ++c) {
    const Index island = element(result.island, c / 3);
    if (island < 0) continue;
    least[island] = least[island].cwiseMin(result.corner_uv.row(c).transpose());
    largest[island] = largest[island].cwiseMax(result.corner_uv.row(c).transpose());
  }
  double room = 0;
  for (Index i = 0; i < count; ++i) room += (largest[i] - least[i]).prod();
  return room > 0 ? area_of(result, result.corner_uv) / room : 1;
}

// The share of the area that is in tubes of components with cones, and in those that are stretched without being laid
// out as strips.
double bent_tubes(const MadeMap& made) {
  const BorderedSurface& surface = *made.surface;
  const Result& result = made.result;
  const SurfaceParts& parts = surface.parts;
  if (!surface.in_tubes || !(parts.area() > 0)) return 0;
  const PerTriangle<char>& in_tubes = *surface.in_tubes;
  const Index count = static_cast<Index>(in_tubes.size());
  PerVertex<char> is_cone(parts.surface().positions.rows(), 0);
  for (const Index v : result.cones) is_cone[v] = 1;
  PerComponent<char> is_bent(parts.count(), 0);
  if (made.options.of_map.border != BorderMode::strips) {
    const PerComponent<double> stretches = stretches_on(parts, result);
    for (Index i = 0; i < parts.count(); ++i) is_bent[i] = !(stretches[i] <= most_l2_of_plain);
  }
  for (Index f = 0; f < count; ++f) {
    const auto corners = parts.surface().triangles.row(f);
    const bool has_cone = is_cone[corners[0]] || is_cone[corners[1]] || is_cone[corners[2]];
    if (in_tubes[f] && has_cone && parts.of_triangle()[f] != none) is_bent[parts.of_triangle()[f]] = 1;
  }
  double area = 0;
  for (Index f = 0; f < count; ++f) {
    const Index part = parts.of_triangle()[f];
    if (in_tubes[f] && part != none && is_bent[part]) area += parts.triangle_areas()[f];
  }
  return area / parts.area();
}

Quality measure(MadeMap& made, SquareShare share, const Progress& progress) {
  constexpr double least_filled = 1e-3;
  const SurfaceParts& parts = made.surface->parts;
  const Result& result = made.result;
  const double size = parts.area() > 0 ? std::sqrt(parts.area()) : 1;
  const bool is_packed = share.squares <= 1 && !result.seamless;
  if (is_packed) made.packed_quickly = packed_quickly(result, progress);
  const double of_square = made.packed_quickly ? area_of(result, *made.packed_quickly) : 0;
  Quality out;
  out.left_out = static_cast<Index>(
      std::count_if(result.island.begin(), result.island.end(), [](Index island) { return island < 0; }));
  out.defects = defect_count(result);
  out.stretch = 100 * (result.distortion.l2_stretch - 1);
  out.islands = island_count(result);
  out.cuts = length_of(parts.surface(), result.cut_edges) / size;
  const PerComponent<double> extra = extra_costs(parts, result);
  out.costly_cuts = std::accumulate(extra.begin(), extra.end(), 0.0) / size;
  out.borders = length_of(parts.surface(), parts.surface().borders) / size;
  out.cones = count_by_area(parts, result.cones);
  out.empty = 1 / std::max(is_packed ? of_square : filled_boxes(result), least_filled) - 1;
  out.on_lattice = cost_on_lattice(result);
  out.bent_tubes = bent_tubes(made);
  return out;
}

}  // namespace

double cost(const Quality& quality, const Weights& weights) {
  const double islands =
      quality.islands <= few_islands ? quality.islands : few_islands * (1 + std::log(quality.islands / few_islands));
  return quality.stretch + weights.islands * islands + weights.cuts * (quality.cuts + quality.costly_cuts) +
         weights.borders * quality.borders + weights.cones * quality.cones + weights.square * quality.empty +
         weights.symmetry * quality.asymmetry + weights.strips * quality.bent_tubes + quality.on_lattice;
}

const Quality& measured(MadeMap& made, SquareShare share, const Progress& progress) {
  if (!made.quality) made.quality = measure(made, share, progress);
  return *made.quality;
}

ComponentCosts costs_on(const SurfaceParts& parts, const MadeMap& made, const Weights& weights) {
  const Result& result = made.result;
  const PerComponent<double> cuts = lengths_on(parts, result.cut_edges);
  const PerComponent<double> extra = extra_costs(parts, result);
  const PerComponent<double> borders = lengths_on(parts, made.surface->surface().borders);
  const PerComponent<Index> islands = islands_on(parts, result), cones = counts_on(parts, result.cones);
  const double price = price_of_island(result, weights);
  const PerComponent<double> excess = excess_on(parts, result);
  ComponentCosts out{excess, excess};
  for (Index i = 0; i < parts.count(); ++i) {
    out.stretch[i] = 100 * excess[i];
    out.whole[i] = out.stretch[i] +
                   (weights.cuts * (cuts[i] + extra[i]) + weights.borders * borders[i]) / std::sqrt(parts.area()) +
                   price * islands[i] + weights.cones * cones[i] * std::sqrt(parts.areas()[i] / parts.area());
  }
  return out;
}

double price_of_island(const Result& result, const Weights& weights) {
  return weights.islands * std::min(1.0, few_islands / std::max<Index>(1, island_count(result)));
}

double count_by_area(const SurfaceParts& parts, const std::vector<Index>& cones) {
  const PerComponent<Index> counts = counts_on(parts, cones);
  double sum = 0;
  for (Index i = 0; i < parts.count(); ++i) sum += counts[i] * std::sqrt(parts.areas()[i] / parts.area());
  return sum;
}

std::string in_words(const Quality& quality) {
  const auto islands = static_cast<Index>(quality.islands);
  std::string said = concat("stretch ", decimals(quality.stretch, 2), " %, ", count(islands, "island", "islands"), ", ",
                            significant(quality.cones, 3), " cones, cuts ", decimals(quality.cuts, 2), ", ",
                            decimals(100 / (1 + quality.empty), 0), " % filled");
  if (quality.costly_cuts != 0) said += ", costly cuts " + decimals(quality.costly_cuts, 2);
  if (quality.borders != 0) said += ", borders " + decimals(quality.borders, 2);
  if (quality.bent_tubes != 0) said += ", bent tubes " + significant(quality.bent_tubes, 2);
  if (quality.asymmetry != 0) said += ", asymmetry " + significant(quality.asymmetry, 2);
  if (quality.defects != 0) said += concat(", ", quality.defects, " defects");
  return quality.left_out == 0 ? said : concat(said, ", ", quality.left_out, " triangles left out");
}

IslandTurns turns_of(const Result& result) {
  if (result.direction_error) return IslandTurns::none;
  return result.features && result.features->share > 0 ? IslandTurns::quarters : IslandTurns::any;
}

}  // namespace lsgp
