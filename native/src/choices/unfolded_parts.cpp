// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/unfolded_parts.hpp"

#include <algorithm>
#include <utility>

#include "base/union_find.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/geometry.hpp"
#include "mesh/thinned_surface.hpp"

namespace lsgp {

namespace {

// Whether a component has triangles that are left out although they have an area.
PerComponent<char> are_left_out(const SurfaceParts& parts, const Result& result) {
  PerComponent<char> out(parts.count(), 0);
  for (std::size_t f = 0; f < result.island.size(); ++f) {
    const Index part = parts.of_triangle()[f];
    if (result.island[f] < 0 && part != none && parts.triangle_areas()[f] > 0) out[part] = 1;
  }
  return out;
}

// Edges of the chosen components of which the others join their triangles to trees. Where cuts may not run, triangles
// stay joined.
VertexPairs edges_off_trees(const SurfaceParts& parts, const PerComponent<char>& is_chosen) {
  struct Link {
    double flatness;  // the cosine of the angle by which the surface bends; more where it may not be cut
    Index low, high, one, other;
  };
  constexpr double uncuttable = 2;
  const Surface& surface = parts.surface();
  const EdgeSet cuttable(surface.edges ? *surface.edges : VertexPairs());
  PerTriangle<char> is_other(surface.triangles.rows(), 0);
  for (std::size_t f = 0; f < is_other.size(); ++f) {
    const Index part = parts.of_triangle()[f];
    is_other[f] = part == none || !is_chosen[part];
  }
  const EdgeTable edges(surface, is_other);
  const PerHalfedge<Index> twin = find_twins(surface, edges);
  const auto normal = [&](Index f) -> Eigen::Vector3d {
    return area_normal(surface.positions, surface.triangles, f).stableNormalized();
  };
  Array<Link> links;
  Array<std::pair<Index, Index>> ends;
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (edges.halfedge_count(edge) < 2) continue;
    const Index h = edges.halfedge(edge, 0), other = twin[h];
    const auto [low, high] = std::minmax({surface.triangles(h / 3, h % 3), surface.triangles(h / 3, (h % 3 + 1) % 3)});
    if (other == none) {
      ends.emplace_back(low, high);
      continue;
    }
    const bool may_be_cut = !surface.edges || cuttable.has(low, high);
    const double bend = normal(h / 3).dot(normal(other / 3));
    links.push_back({may_be_cut ? bend : uncuttable, low, high, h / 3, other / 3});
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.flatness > b.flatness; });
  UnionFind pieces(static_cast<Index>(surface.triangles.rows()));
  for (const Link& link : links) {
    if (!pieces.unite(link.one, link.other) && link.flatness < uncuttable) ends.emplace_back(link.low, link.high);
  }
  return to_rows(ends);
}

CompletedCones beside(const CompletedCones& cones, const SurfaceParts& parts, const PerComponent<char>& is_chosen) {
  CompletedCones out = cones;
  out.cones = {};
  for (std::size_t i = 0; i < cones.cones.vertices.size(); ++i) {
    const Index part = parts.of_vertex()[cones.cones.vertices[i]];
    if (part != none && is_chosen[part]) continue;
    out.cones.vertices.push_back(cones.cones.vertices[i]);
    out.cones.angles.push_back(cones.cones.angles[i]);
  }
  return out;
}

}  // namespace

Made with_unfolded_parts(const Made& made, const MapOptions& options, Objective& objective, const Progress& progress) {
  const SurfaceParts& parts = made->surface->parts;
  const PerComponent<char> is_left_out = are_left_out(parts, made->result);
  if (std::count(is_left_out.begin(), is_left_out.end(), 1) == 0) return made;
  const VertexPairs ends = edges_off_trees(parts, is_left_out);
  if (ends.rows() == 0) return made;
  const Pins no_pins;
  const Made unfolded = attempt([&] {
    Surface opened = parts.surface();
    opened.borders = joined(opened.borders, ends);
    const auto surface =
        std::make_shared<BorderedSurface>(std::move(opened), made->surface->in_tubes, made->surface.get());
    MapOptions others = options;
    others.of_map.border = made->options.of_map.border;
    return maps_of(surface, no_pins)(beside(made->cones, parts, is_left_out), others, progress);
  });
  if (!unfolded) return made;
  tell_findings(*unfolded, options.of_map);
  const Quality before = objective.quality(*made, progress), after = objective.quality(*unfolded, progress);
  const bool is_better = after.left_out < before.left_out && after.defects <= before.defects;
  objective.note("parts without a map unfolded", after, Objective::infinity, is_better);
  return is_better ? unfolded : made;
}

}  // namespace lsgp
