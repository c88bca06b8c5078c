// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/part_of_surface.hpp"

#include "mesh/edge_set.hpp"

namespace lsgp {

Surface part_of(const Surface& surface, const std::vector<Index>& triangles) {
  Surface out;
  out.positions = surface.positions;
  out.importance = surface.importance;
  out.scale = surface.scale;
  out.may_collapse = surface.may_collapse;
  const auto count = static_cast<Eigen::Index>(triangles.size());
  const bool has_directions = surface.directions.rows() > 0;
  out.triangles.resize(count, 3);
  if (has_directions) out.directions.resize(count, 3);
  VertexPairs sides(3 * count, 2);
  for (Eigen::Index f = 0; f < count; ++f) {
    out.triangles.row(f) = surface.triangles.row(element(triangles, f));
    if (has_directions) out.directions.row(f) = surface.directions.row(element(triangles, f));
    for (Eigen::Index k = 0; k < 3; ++k) sides.row(3 * f + k) << out.triangles(f, k), out.triangles(f, (k + 1) % 3);
  }
  const EdgeSet own(sides);
  const auto on_them = [&](const VertexPairs& edges) {
    return filtered(edges, [&](Eigen::Index e) { return own.has(edges(e, 0), edges(e, 1)); });
  };
  out.seams = on_them(surface.seams);
  out.borders = on_them(surface.borders);
  out.features = on_them(surface.features);
  if (!surface.edges) return out;
  out.edges = on_them(*surface.edges);
  if (surface.cut_costs.size() == 0) return out;
  out.cut_costs.resize(out.edges->rows());
  Eigen::Index next = 0;
  for (Eigen::Index e = 0; e < surface.edges->rows(); ++e) {
    if (own.has((*surface.edges)(e, 0), (*surface.edges)(e, 1))) out.cut_costs[next++] = surface.cut_costs[e];
  }
  return out;
}

}  // namespace lsgp
