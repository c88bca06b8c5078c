// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/map_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lsgp {

namespace {

// Of the L2 stretch without features along the lattice, and what share of their length has to lie there.
constexpr double most_l2_for_features = 1.1;
constexpr double least_features = 0.25;
constexpr double most_features = 0.95;
// Shares of features that are worth as much as L2 stretch of 1, and as tiles twice as large.
constexpr double features_for_stretch = 2.5;
constexpr double features_for_tiles = 0.25;
// Where more creases than these are off the lattice, as on a coarse model of a round shape, the texture has no
// direction in common with them, and those along it are worth half.
constexpr double features_in_common = 0.75;
constexpr double worth_without_direction = 0.5;
constexpr double most_l2_for_strokes = 1.1;

// Of the L2 stretch through cones for features, from a map with this share of features along the lattice: these cones
// may cost a tenth, and features, where none are along it yet, another.
double most_growth(double share) { return (share >= least_features ? 1 : most_l2_for_features) * most_l2_for_features; }

// Whether tiles are said to be larger in some places than in others.
bool has_uneven_tiles(const Result& result) {
  return std::any_of(result.warnings.begin(), result.warnings.end(),
                     [](const Finding& finding) { return finding.code == Code::high_distortion; });
}

double worth(double share, double l2_stretch, double tile_size, bool is_uneven) {
  return share * (has_direction(share) ? 1 : worth_without_direction) - features_for_stretch * l2_stretch +
         features_for_tiles * (std::log2(tile_size) - (is_uneven ? 1 : 0));
}

double cost_of_layout(const Result& result, double share, bool is_uneven) {
  return result.seamless ? -in_hundredths(worth(share, 0, result.seamless->tile_size, is_uneven)) : 0;
}

// The feature_share of each component, 0 without features.
PerComponent<double> feature_shares(const SurfaceParts& parts, const Result& result) {
  Array<Index> every, off;  // pairs of vertices
  if (result.features) {
    const VertexPairs& features = parts.surface().features;
    every.assign(features.data(), features.data() + features.size());
    for (const ReleasedFeature& feature : result.features->released) {
      for (std::size_t i = 1; i < feature.path.size(); ++i) {
        off.insert(off.end(), {feature.path[i - 1], feature.path[i]});
      }
    }
  } else if (result.seamless) {
    every.assign(result.seamless->creases.begin(), result.seamless->creases.end());
    for (std::size_t e = 0; e < result.seamless->is_crease_aligned.size(); ++e) {
      if (!result.seamless->is_crease_aligned[e]) off.insert(off.end(), {every[2 * e], every[2 * e + 1]});
    }
  }
  const auto lengths = [&](const Array<Index>& pairs) {
    return lengths_on(parts, Eigen::Map<const VertexPairs>(pairs.data(), ssize(pairs) / 2, 2));
  };
  PerComponent<double> out = lengths(off);
  const PerComponent<double> all = lengths(every);
  for (Index i = 0; i < parts.count(); ++i) out[i] = all[i] > 0 ? 1 - out[i] / all[i] : 0;
  return out;
}

}  // namespace

Index defect_count(const Result& result) {
  return static_cast<Index>(result.flipped.size() + result.wrong_angle_sums.size() + result.overlapping.size());
}

Index island_count(const Result& result) {
  Array<Index> islands;
  std::copy_if(result.island.begin(), result.island.end(), std::back_inserter(islands), [](Index i) { return i >= 0; });
  sort_unique(islands);
  return static_cast<Index>(islands.size());
}

bool is_as_good(const Result& other, const Result& usual, double most_l2) {
  const bool has_all = std::equal(other.island.begin(), other.island.end(), usual.island.begin(), usual.island.end(),
                                  [](Index one, Index another) { return one >= 0 || another < 0; });
  return has_all && defect_count(other) <= defect_count(usual) && other.distortion.l2_stretch <= most_l2;
}

double feature_share(const Result& result) {
  if (result.features) return result.features->share;
  return result.seamless ? result.seamless->feature_share.value_or(0) : 0;
}

bool runs_along_features(const Result& result) { return feature_share(result) >= least_features; }

bool releases_features(const Result& result) { return feature_share(result) < most_features; }

double direction_error(const Result& result) { return result.direction_error.value_or(0); }

bool has_direction(double share) { return share >= features_in_common; }

double seamless_worth(double share, double l2_stretch, const Result& result) {
  return worth(share, l2_stretch, result.seamless->tile_size, has_uneven_tiles(result));
}

double worth_along_features(const Result& result) {
  return seamless_worth(feature_share(result), result.distortion.l2_stretch, result);
}

double cost_on_lattice(const Result& result) {
  return cost_of_layout(result, feature_share(result), has_uneven_tiles(result));
}

double least_cost_on_lattice(const Result& result) { return cost_of_layout(result, 1, has_uneven_tiles(result)); }

double in_hundredths(double worth) { return 100 * worth / features_for_stretch; }

double cost_on_even_lattice(const Result& result) { return cost_of_layout(result, feature_share(result), false); }

bool runs_along_axes(const SurfaceParts& parts, const Result& result, Index a, Index b) {
  constexpr double rounding = 1e-6;  // of the length of an edge along an axis
  bool is_along = false;
  parts.for_each_side(a, b, [&](Index side) {
    const Index next = side % 3 == 2 ? side - 2 : side + 1;
    const double du = std::abs(result.corner_uv(next, 0) - result.corner_uv(side, 0));
    const double dv = std::abs(result.corner_uv(next, 1) - result.corner_uv(side, 1));
    is_along = is_along || std::min(du, dv) <= rounding * std::max(du, dv);
  });
  return is_along;
}

bool may_replace_for_features(const Result& along, const Result& usual) {
  if (feature_share(usual) > feature_share(along)) return false;
  const double most_l2 = most_growth(feature_share(usual)) * usual.distortion.l2_stretch;
  return is_as_good(along, usual, most_l2) && runs_along_features(along);
}

bool may_replace_straighter(const Result& straighter, const Result& usual) {
  const double gain = feature_share(straighter) - feature_share(usual);
  const double more = straighter.distortion.l2_stretch - usual.distortion.l2_stretch;
  return is_as_good(straighter, usual, most_l2_for_features * usual.distortion.l2_stretch) &&
         island_count(straighter) <= island_count(usual) && gain > std::max(0.0, features_for_stretch * more);
}

bool follows_strokes_better(const Result& toward, const Result& usual) {
  return is_as_good(toward, usual, most_l2_for_strokes * usual.distortion.l2_stretch) &&
         island_count(toward) <= island_count(usual) &&
         direction_error(toward) < direction_error(usual) - least_direction_error;
}

PerComponent<char> gains_features(const SurfaceParts& parts, const Result& along, const Result& usual,
                                  UsualFeatures features) {
  const PerComponent<double> shares = feature_shares(parts, along), others = feature_shares(parts, usual);
  const PerComponent<double> stretches = stretches_on(parts, along), usual_stretches = stretches_on(parts, usual);
  const PerComponent<Index> solved = solved_on(parts, along), usual_solved = solved_on(parts, usual);
  const PerComponent<Index> defects = defects_on(parts, along), usual_defects = defects_on(parts, usual);
  PerComponent<char> out(parts.count(), 0);
  for (Index i = 0; i < parts.count(); ++i) {
    const double most = features == UsualFeatures::as_far_as_they_can ? most_growth(others[i]) : most_l2_for_features;
    out[i] = shares[i] >= std::max(others[i], least_features) && solved[i] == usual_solved[i] &&
             defects[i] <= usual_defects[i] && stretches[i] <= most * usual_stretches[i];
  }
  return out;
}

double left_of_stretch(Mode mode) { return mode == Mode::low_stretch ? 0.5 : 1; }

double reached_up_to(double target, const Result& result, Mode mode) {
  if (result.seamless && runs_along_features(result)) return most_l2_for_features * target;
  return mode == Mode::low_stretch ? target : 0;
}

}  // namespace lsgp
