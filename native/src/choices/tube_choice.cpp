// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/tube_choice.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "base/number_text.hpp"
#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/large_surface.hpp"
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

PerComponent<double> areas_of_tubes(const SurfaceParts& parts, const PerTriangle<char>& in_tubes) {
  PerComponent<double> out(parts.count(), 0);
  for (std::size_t f = 0; f < in_tubes.size(); ++f) {
    if (in_tubes[f] && parts.of_triangle()[f] != none) out[parts.of_triangle()[f]] += parts.triangle_areas()[f];
  }
  return out;
}

// Whether each component consists of tubes, instead of having some for handles.
PerComponent<char> consist_of_tubes(const SurfaceParts& parts, const PerTriangle<char>& in_tubes) {
  constexpr double most_of_handles = 0.5;  // of the area; what consists of tubes has four fifths
  const PerComponent<double> area = areas_of_tubes(parts, in_tubes);
  PerComponent<char> out(parts.count(), 0);
  for (Index i = 0; i < parts.count(); ++i) out[i] = area[i] > most_of_handles * parts.areas()[i];
  return out;
}

PerTriangle<char> triangles_in(const Tubes& tubes, const SurfaceParts& parts) {
  PerTriangle<char> out(parts.surface().triangles.rows(), 0);
  for (const Index f : tubes.triangles) out[f] = 1;
  return out;
}

// Those of some edges that are neither on components that consist of tubes nor on handles.
VertexPairs beside_tubes(const VertexPairs& edges, const SurfaceParts& parts, const PerTriangle<char>& in_tubes) {
  const PerComponent<char> consists = consist_of_tubes(parts, in_tubes);
  return filtered(edges, [&](Eigen::Index e) {
    bool is_beside = true;
    parts.for_each_side(edges(e, 0), edges(e, 1), [&](Index side) {
      const Index f = side / 3, part = parts.of_triangle()[f];
      is_beside = is_beside && !in_tubes[f] && (part == none || !consists[part]);
    });
    return is_beside;
  });
}

// Of some components alone.
void keep_on(const SurfaceParts& parts, const PerComponent<char>& is_kept, Tubes& tubes) {
  const auto is_other = [&](Index f) {
    return f == none || parts.of_triangle()[f] == none || !is_kept[parts.of_triangle()[f]];
  };
  std::vector<Index>& own = tubes.triangles;
  own.erase(std::remove_if(own.begin(), own.end(), is_other), own.end());
  const VertexPairs& all = tubes.borders;
  tubes.borders =
      VertexPairs(filtered(all, [&](Eigen::Index e) { return !is_other(parts.triangle_at(all(e, 0), all(e, 1))); }));
}

// Closed components with creases whose tubes end nowhere: washers and walls of pipes, which unfold without stretch
// between their creases.
PerComponent<char> creased_rings(const SurfaceParts& parts, const CreaseBorders& creases, const Tubes& tubes) {
  PerComponent<char> out = have_edges(parts, joined(creases.required, creases.possible));
  const PerComponent<char> ends = have_edges(parts, joined(tubes.borders, parts.surface().seams));
  for (Index i = 0; i < parts.count(); ++i) out[i] = out[i] && !ends[i];
  for (const Index f : tubes.triangles) {
    const auto corners = parts.surface().triangles.row(f);
    for (int i = 0; i < 3; ++i) {
      Index sides = 0;
      parts.for_each_side(corners[i], corners[(i + 1) % 3], [&](Index) { ++sides; });
      if (sides < 2 && parts.of_triangle()[f] != none) out[parts.of_triangle()[f]] = 0;
    }
  }
  return out;
}

// Without handles each of which is worth less than the island it becomes.
void leave_out_small_handles(const SurfaceParts& parts, const Weights& weights, Tubes& tubes) {
  const PerTriangle<char> in_tubes = triangles_in(tubes, parts);
  const PerComponent<char> consists = consist_of_tubes(parts, in_tubes);
  Surface ending = parts.surface();
  ending.borders = joined(ending.borders, tubes.borders);
  const SurfaceParts pieces{std::cref(ending)};
  const PerComponent<double> area = areas_of_tubes(pieces, in_tubes);
  const double least = (weights.islands + error_of_estimates) * parts.area();
  PerTriangle<char> is_kept(in_tubes.size(), 0);
  std::vector<Index> kept;
  for (const Index f : tubes.triangles) {
    const Index part = parts.of_triangle()[f], piece = pieces.of_triangle()[f];
    is_kept[f] = part != none && (consists[part] || (piece != none && weights.strips * area[piece] > least));
    if (is_kept[f]) kept.push_back(f);
  }
  tubes.triangles = std::move(kept);
  const VertexPairs& all = tubes.borders;
  tubes.borders = VertexPairs(filtered(all, [&](Eigen::Index e) {
    bool is_end = false;
    parts.for_each_side(all(e, 0), all(e, 1), [&](Index side) { is_end = is_end || is_kept[side / 3]; });
    return is_end;
  }));
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

// Whether each component is laid out without cones, and continues across its cuts without a turn, but for one by right
// angles, as what tapers does not.
PerComponent<char> run_on_across_cuts(const SurfaceParts& parts, const Result& result) {
  constexpr double rounding = 0.01;  // radians
  PerComponent<char> out(parts.count(), 1);
  const PerComponent<Index> cones = counts_on(parts, result.cones);
  for (Index i = 0; i < parts.count(); ++i) out[i] = cones[i] == 0;
  const auto direction = [&](Index side) {
    const Eigen::Index next = side % 3 == 2 ? side - 2 : side + 1;
    const Eigen::RowVector2d along = result.corner_uv.row(next) - result.corner_uv.row(side);
    return std::atan2(along[1], along[0]);
  };
  for (Eigen::Index e = 0; e < result.cut_edges.rows(); ++e) {
    std::vector<Index> sides;
    parts.for_each_side(result.cut_edges(e, 0), result.cut_edges(e, 1), [&](Index side) { sides.push_back(side); });
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Index part = parts.of_triangle()[sides[i] / 3];
      if (part == none || parts.of_triangle()[sides[i - 1] / 3] != part) continue;
      const double turn = std::remainder(direction(sides[i]) - direction(sides[i - 1]), M_PI / 2);
      if (!(std::abs(turn) < rounding)) out[part] = 0;
    }
  }
  return out;
}

}  // namespace

Tubes tubes_for(const Surface& surface, const GivenCones& given, const CreaseBorders& creases,
                const MapOptions& options, const Progress& progress) {
  if (options.of_map.seamless) return {};
  const bool is_plain = options.of_map.border == BorderMode::free && options.of_map.loop_turning.empty();
  if (!is_plain || given.count) return {};
  Tubes out = find_tubes(surface, given.cones.vertices, share_of(progress, 0, 0));
  if (out.triangles.empty()) return out;
  const SurfaceParts parts{std::cref(surface)};
  if (options.of_map.seams == SeamMode::exact) {
    keep_on(parts, have_edges(parts, parts.surface().seams), out);
    out.borders.resize(0, 2);
  }
  PerComponent<char> is_kept = creased_rings(parts, creases, out);
  for (char& each : is_kept) each = !each;
  keep_on(parts, is_kept, out);
  if (surface.triangles.rows() >= least_large) keep_on(parts, consist_of_tubes(parts, triangles_in(out, parts)), out);
  return out;
}

Made best_of_tubes(const Surface& surface, const EndsOfSurface& ends, const MakeWithTubes& make, Objective& objective,
                   const Progress& progress) {
  const CreaseBorders& creases = ends.creases;
  Tubes tubes = ends.tubes;
  std::shared_ptr<PerTriangle<char>> in_tubes;
  if (!tubes.triangles.empty()) {
    const SurfaceParts all{std::cref(surface)};
    leave_out_small_handles(all, objective.weights(), tubes);
    if (!tubes.triangles.empty()) in_tubes = std::make_shared<PerTriangle<char>>(triangles_in(tubes, all));
  }
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
  BorderedSurfaces unrolled = ending_at(joined(beside_tubes(creases.required, parts, *in_tubes), tubes.borders));
  const CreaseBorders others{{}, beside_tubes(creases.possible, parts, *in_tubes)};
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

void tell_stretched_strips(MadeMap& made) {
  if (made.options.of_map.border != BorderMode::strips || !made.surface->in_tubes) return;
  const SurfaceParts& parts = made.surface->parts;
  const PerTriangle<char>& in_tubes = *made.surface->in_tubes;
  const PerComponent<double> stretches = stretches_on(parts, made.result);
  const PerComponent<char> are_rectangles = run_on_across_cuts(parts, made.result);
  double most = 0;
  std::vector<Index> triangles;
  for (Index f = 0; f < static_cast<Index>(in_tubes.size()); ++f) {
    const Index part = parts.of_triangle()[f];
    if (!in_tubes[f] || part == none || !are_rectangles[part] || !(stretches[part] > Tubes::most_l2)) continue;
    most = std::max(most, stretches[part]);
    triangles.push_back(f);
  }
  if (triangles.empty()) return;
  made.result.warnings.push_back(
      {Code::high_distortion,
       concat("Tubes that wind or bend tightly are longer on one side than on the other: as straight strips they are "
              "stretched by up to ",
              decimals(100 * (most - 1), 1), " %. With the weight of strips at 0 they get cones instead."),
       {ElementKind::triangles, std::move(triangles)}});
}

}  // namespace lsgp
