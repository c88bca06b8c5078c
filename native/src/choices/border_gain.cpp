// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/border_gain.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "measures/map_comparison.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

constexpr double well_filled = 0.65;  // more of the square is rarely filled
// Share of creases along the lattice that is worth as much as a texture that runs on across them.
constexpr double worth_of_running_on = 0.15;
constexpr double most_l2 = 1.1;
// Of the area, where the mesh is not small: seamless layouts take long, and what is smaller is hardly seen.
constexpr double least_area = 0.05;
constexpr Index small_mesh = 5000;  // triangles

template <typename Predicate>
Array<Index> those_of(const Array<Index>& components, Predicate is_meant) {
  Array<Index> out;
  std::copy_if(components.begin(), components.end(), std::back_inserter(out), is_meant);
  return out;
}

// Each edge once, ordered by its vertices.
VertexPairs without_repeats(const VertexPairs& edges) {
  using Edge = std::pair<Index, Index>;
  const auto ends = [&](Index e) { return Edge(std::minmax(edges(e, 0), edges(e, 1))); };
  Array<Index> order(edges.rows());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index e, Index f) { return ends(e) < ends(f); });
  const auto is_same = [&](Index e, Index f) { return ends(e) == ends(f); };
  order.erase(std::unique(order.begin(), order.end(), is_same), order.end());
  VertexPairs out(ssize(order), 2);
  for (std::ptrdiff_t i = 0; i < ssize(order); ++i) out.row(i) = edges.row(order[i]);
  return out;
}

}  // namespace

PossibleBorders::PossibleBorders(const SurfaceParts& parts, VertexPairs borders) : edges(std::move(borders)) {
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    const Index f = parts.triangle_at(edges(e, 0), edges(e, 1));
    component.push_back(f == none ? none : parts.of_triangle()[f]);
  }
}

VertexPairs PossibleBorders::of(const Array<Index>& components) const {
  return filtered(edges, [&](Eigen::Index e) {
    return std::find(components.begin(), components.end(), component[e]) != components.end();
  });
}

LowerCost::LowerCost(const SurfaceParts& parts, const PossibleBorders& borders, const BorderKind& kind,
                     Objective& objective)
    : parts_(parts), borders_(borders), kind_(kind), objective_(objective), seen_(parts.count(), 0) {
  if (!kind.counts_sight) return;
  seen_ = extra_costs_on(parts, borders.edges);
  for (double& own : seen_) own *= objective.weights().cuts / std::sqrt(parts.area());
}

Array<Index> LowerCost::promising(MadeMap& usual, const Array<Index>& chosen, const Progress& progress) {
  const Weights& weights = objective_.weights();
  const ComponentCosts present = costs_on(parts_, usual, weights);
  const PerComponent<Index> count = pieces();
  const PerComponent<double> lengths = lengths_on(parts_, borders_.edges);
  const PerComponent<double> in_sight = extra_costs_on(parts_, usual.result.cut_edges);
  const double empty = objective_.quality(usual, progress).empty;
  const double of_square = weights.square * std::max(0.0, empty + 1 - 1 / well_filled);
  return those_of(chosen, [&](Index i) {
    const double share = parts_.areas()[i] / parts_.area();
    if (weights.cuts * in_sight[i] < kind_.least_in_sight * std::sqrt(parts_.areas()[i])) return false;
    const double expected = kind_.stretch_kept * present.stretch[i] + kind_.stretch * share + seen_[i] +
                            price_of_island(usual.result, weights) * count[i] +
                            weights.borders * lengths[i] / std::sqrt(parts_.area());
    const double gain = present.whole[i] - expected + of_square * share;
    return gain > -error_of_estimates;
  });
}

PerComponent<Index> LowerCost::pieces() const {
  Surface opened = parts_.surface();
  opened.borders = joined(opened.borders, borders_.edges);
  const SurfaceParts all(std::cref(opened));
  Array<std::pair<Index, Index>> pairs;
  for (std::size_t f = 0; f < all.of_triangle().size(); ++f) {
    if (parts_.of_triangle()[f] == none || all.of_triangle()[f] == none) continue;
    pairs.emplace_back(parts_.of_triangle()[f], all.of_triangle()[f]);
  }
  sort_unique(pairs);
  PerComponent<Index> out(parts_.count(), 0);
  for (const auto& [component, piece] : pairs) ++out[component];
  return out;
}

Array<Index> LowerCost::gaining(MadeMap& bordered, MadeMap& usual, const Array<Index>& chosen) {
  const bool is_best = may_replace(bordered, usual, {});
  objective_.note(kind_.name, with_sight(bordered, {}), Objective::infinity, is_best);
  if (is_best) return chosen;
  const PerComponent<double> costs = costs_on(parts_, bordered, objective_.weights()).whole;
  const PerComponent<double> others = costs_on(parts_, usual, objective_.weights()).whole;
  return those_of(chosen, [&](Index i) { return costs[i] + seen_[i] < others[i]; });
}

bool LowerCost::may_replace(MadeMap& bordered, MadeMap& usual, const Progress& progress) {
  return is_as_good(bordered.result, usual.result, Objective::infinity) &&
         cost(with_sight(bordered, progress), objective_.weights()) < objective_.cost_of(usual, progress);
}

// The quality of a map, with what is seen of its further borders.
Quality LowerCost::with_sight(MadeMap& bordered, const Progress& progress) const {
  Quality out = objective_.quality(bordered, progress);
  if (!kind_.counts_sight) return out;
  const EdgeSet present(bordered.surface->surface().borders);
  const VertexPairs& all = borders_.edges;
  const VertexPairs own = filtered(all, [&](Eigen::Index e) { return present.has(all(e, 0), all(e, 1)); });
  for (const double extra : extra_costs_on(parts_, own)) out.costly_cuts += extra / std::sqrt(parts_.area());
  return out;
}

Array<Index> AlongLattice::promising(MadeMap& usual, const Array<Index>& chosen, const Progress&) {
  const PerComponent<double> stretches = stretches_on(parts_, usual.result);
  const PerComponent<double> along = shares(usual, creases({&usual}));
  const PerComponent<Index> solved = solved_on(parts_, usual.result), all = triangles_on(parts_);
  const PerComponent<Index> defects = defects_on(parts_, usual.result);
  const auto is_promising = [&](Index i) {
    return defects[i] > 0 || solved[i] < all[i] || stretches[i] > most_l2 || !has_direction(along[i]);
  };
  return if_large(those_of(chosen, is_promising), defects);
}

Array<Index> AlongLattice::gaining(MadeMap& bordered, MadeMap& usual, const Array<Index>& chosen) {
  const VertexPairs edges = creases({&bordered, &usual});
  const auto worth = [&](const MadeMap& made) {
    const PerComponent<double> along = shares(made, edges), stretches = stretches_on(parts_, made.result);
    PerComponent<double> out(parts_.count());
    for (Index i = 0; i < parts_.count(); ++i) out[i] = seamless_worth(along[i], stretches[i], made.result);
    return out;
  };
  const PerComponent<double> worths = worth(bordered), others = worth(usual);
  const PerComponent<Index> solved = solved_on(parts_, bordered.result), before = solved_on(parts_, usual.result);
  const PerComponent<Index> defects = defects_on(parts_, bordered.result), flawed = defects_on(parts_, usual.result);
  const auto gains = [&](Index i) {
    if (solved[i] != before[i]) return solved[i] > before[i];
    if (defects[i] != flawed[i]) return defects[i] < flawed[i];
    return worths[i] >= others[i] + worth_of_running_on;
  };
  return if_large(those_of(chosen, gains), flawed);
}

bool is_outdone_at_creases(const Result& usual, const Quality& ended) {
  const double l2 = usual.distortion.l2_stretch;
  const double least = 100 * (l2 - 1) + least_cost_on_lattice(usual);
  return l2 > most_l2 && ended.stretch + ended.on_lattice + in_hundredths(worth_of_running_on) <= least;
}

bool AlongLattice::may_replace(MadeMap& bordered, MadeMap& usual, const Progress&) {
  return is_as_good(bordered.result, usual.result, Objective::infinity);
}

Array<Index> AlongLattice::if_large(const Array<Index>& components, const PerComponent<Index>& defects) const {
  double area = 0;
  for (const Index i : components) area += parts_.areas()[i];
  const bool is_large = area >= least_area * parts_.area();
  if (is_large || parts_.surface().triangles.rows() <= small_mesh) return components;
  return those_of(components, [&](Index i) { return defects[i] > 0; });
}

VertexPairs AlongLattice::creases(const Array<const MadeMap*>& maps) const {
  if (parts_.surface().features.rows() > 0) return parts_.surface().features;
  VertexPairs edges = borders_.edges;
  for (const MadeMap* made : maps) {
    const std::vector<Index>& found = made->result.seamless->creases;
    edges = joined(edges, Eigen::Map<const VertexPairs>(found.data(), ssize(found) / 2, 2));
  }
  return without_repeats(edges);
}

PerComponent<double> AlongLattice::shares(const MadeMap& made, const VertexPairs& edges) const {
  PerComponent<double> out = lengths_on(parts_, filtered(edges, [&](Eigen::Index e) {
                                          return runs_along_axes(parts_, made.result, edges(e, 0), edges(e, 1));
                                        }));
  const PerComponent<double> every = lengths_on(parts_, edges);
  for (Index i = 0; i < parts_.count(); ++i) out[i] = every[i] > 0 ? out[i] / every[i] : 1;
  return out;
}

}  // namespace lsgp
