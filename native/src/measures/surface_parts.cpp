// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/surface_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/lower_quartile.hpp"
#include "lsgp/lsgp.hpp"
#include "measures/triangle_measures.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

void count_in(Index component, PerComponent<Index>& counts) {
  if (component != none) ++counts[component];
}

}  // namespace

SurfaceParts::SurfaceParts(Borrowed<const Surface> surface)
    : surface_(surface),
      of_triangle_(surface_.triangles.rows(), none),
      of_vertex_(surface_.positions.rows(), none),
      first_corner_(surface_.positions.rows() + 1, 0) {
  const std::vector<LedgerPart> found = build_ledger(surface_, {});
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const Index f : found[i].triangles) of_triangle_[f] = static_cast<Index>(i);
    are_plain_.push_back(found[i].inside.empty() && found[i].euler == 1);
  }
  triangle_areas_ = areas_of(surface_);
  areas_.assign(found.size(), 0);
  const Index* corner = surface_.triangles.data();
  for (Index f = 0; f < surface_.triangles.rows(); ++f) {
    for (Index k = 0; k < 3; ++k) ++first_corner_[corner[3 * f + k] + 1];
    if (of_triangle_[f] == none) continue;
    areas_[of_triangle_[f]] += triangle_areas_[f];
    for (Index k = 0; k < 3; ++k) of_vertex_[corner[3 * f + k]] = of_triangle_[f];
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const Index v : found[i].inside) of_vertex_[v] = static_cast<Index>(i);
  }
  area_ = std::accumulate(areas_.begin(), areas_.end(), 0.0);
  std::partial_sum(first_corner_.begin(), first_corner_.end(), first_corner_.begin());
  corners_.resize(surface_.triangles.size());
  Array<Index> next(first_corner_.begin(), first_corner_.end());
  for (Index c = 0; c < surface_.triangles.size(); ++c) corners_[next[corner[c]]++] = c;
}

Index SurfaceParts::triangle_at(Index a, Index b) const {
  Index first = none;
  for_each_side(a, b, [&](Index side) {
    if (first == none) first = side / 3;
  });
  return first;
}

double length_of(const Surface& surface, const VertexPairs& edges) {
  double sum = 0;
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    sum += (surface.positions.row(edges(e, 1)) - surface.positions.row(edges(e, 0))).norm();
  }
  return sum;
}

PerComponent<double> lengths_on(const SurfaceParts& parts, const VertexPairs& edges) {
  PerComponent<double> out(parts.count(), 0);
  const Positions& positions = parts.surface().positions;
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    const Index f = parts.triangle_at(edges(e, 0), edges(e, 1));
    if (f == none || parts.of_triangle()[f] == none) continue;
    out[parts.of_triangle()[f]] += (positions.row(edges(e, 1)) - positions.row(edges(e, 0))).norm();
  }
  return out;
}

PerComponent<double> extra_costs_on(const SurfaceParts& parts, const VertexPairs& cuts) {
  PerComponent<double> out(parts.count(), 0);
  const Surface& surface = parts.surface();
  if (surface.cut_costs.size() == 0 || cuts.rows() == 0) return out;
  const double usual = std::max(1.0, lower_quartile(surface.cut_costs));
  const EdgeSet is_cut(cuts);
  for (Eigen::Index e = 0; e < surface.cut_costs.size(); ++e) {
    const Index a = (*surface.edges)(e, 0), b = (*surface.edges)(e, 1);
    if (!(surface.cut_costs[e] > usual) || !is_cut.has(a, b)) continue;
    const Index f = parts.triangle_at(a, b);
    if (f == none || parts.of_triangle()[f] == none) continue;
    const double length = (surface.positions.row(b) - surface.positions.row(a)).norm();
    out[parts.of_triangle()[f]] += (surface.cut_costs[e] / usual - 1) * length;
  }
  return out;
}

PerComponent<char> have_edges(const SurfaceParts& parts, const VertexPairs& edges) {
  PerComponent<char> out(parts.count(), 0);
  for (Index e = 0; e < edges.rows(); ++e) {
    const Index f = parts.triangle_at(edges(e, 0), edges(e, 1));
    if (f != none && parts.of_triangle()[f] != none) out[parts.of_triangle()[f]] = 1;
  }
  return out;
}

PerComponent<Index> counts_on(const SurfaceParts& parts, const std::vector<Index>& vertices) {
  PerComponent<Index> out(parts.count(), 0);
  for (const Index v : vertices) count_in(parts.of_vertex()[v], out);
  return out;
}

PerComponent<Index> triangles_on(const SurfaceParts& parts) {
  PerComponent<Index> out(parts.count(), 0);
  for (const Index part : parts.of_triangle()) count_in(part, out);
  return out;
}

PerComponent<Index> solved_on(const SurfaceParts& parts, const Result& result) {
  PerComponent<Index> out(parts.count(), 0);
  for (std::size_t f = 0; f < result.island.size(); ++f) {
    if (result.island[f] >= 0) count_in(parts.of_triangle()[f], out);
  }
  return out;
}

PerComponent<Index> islands_on(const SurfaceParts& parts, const Result& result) {
  Array<std::pair<Index, Index>> pairs;
  for (std::size_t f = 0; f < result.island.size(); ++f) {
    if (result.island[f] >= 0) pairs.emplace_back(parts.of_triangle()[f], result.island[f]);
  }
  sort_unique(pairs);
  PerComponent<Index> out(parts.count(), 0);
  for (const auto& [component, island] : pairs) count_in(component, out);
  return out;
}

PerComponent<Index> defects_on(const SurfaceParts& parts, const Result& result) {
  PerComponent<Index> out = counts_on(parts, result.wrong_angle_sums);
  for (const Index f : result.flipped) count_in(parts.of_triangle()[f], out);
  for (const Index f : result.overlapping) count_in(parts.of_triangle()[f], out);
  return out;
}

PerComponent<double> stretches_on(const SurfaceParts& parts, const Result& result) {
  const PerTriangle<SingularValues> values = singular_values(parts.surface(), result.corner_uv);
  PerComponent<double> image(parts.count(), 0), spread(parts.count(), 0), out(parts.count(), 0);
  for (std::size_t f = 0; f < values.size(); ++f) {
    const double area = parts.triangle_areas()[f];
    const Index component = parts.of_triangle()[f];
    if (component == none || area == 0) continue;
    const auto [largest, smallest] = values[f];
    image[component] += area * largest * smallest;
    spread[component] += area * (1 / (largest * largest) + 1 / (smallest * smallest)) / 2;
  }
  for (Index i = 0; i < parts.count(); ++i) out[i] = std::sqrt(spread[i] * image[i]) / parts.areas()[i];
  return out;
}

PerComponent<double> excess_on(const SurfaceParts& parts, const Result& result) {
  PerComponent<double> out = stretches_on(parts, result);
  for (Index i = 0; i < parts.count(); ++i) {
    const double share = parts.areas()[i] / parts.area();
    const double excess = std::isnan(out[i]) ? std::numeric_limits<double>::infinity() : out[i] - 1;
    out[i] = share > 0 ? share * excess : 0;
  }
  return out;
}

}  // namespace lsgp
