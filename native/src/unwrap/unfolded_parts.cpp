// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/unfolded_parts.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/union_find.hpp"
#include "mesh/topology.hpp"
#include "unwrap/edge_set.hpp"

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

// A side of a triangle, and its edge's vertices in order.
struct Side {
  Index low, high, triangle;
  bool is_upward;  // from the low to the high one

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.is_upward) < std::tie(b.low, b.high, b.triangle, b.is_upward);
  }
};

Array<Side> sides_on(const SurfaceParts& parts, const PerComponent<char>& is_chosen) {
  Array<Side> out;
  const auto& triangles = parts.surface().triangles;
  for (Index f = 0; f < triangles.rows(); ++f) {
    const Index part = parts.of_triangle()[f];
    if (part == none || !is_chosen[part]) continue;
    for (Index k = 0; k < 3; ++k) {
      const Index a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      out.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

Eigen::RowVector3d normal_of(const Surface& surface, Index f) {
  const auto corner = [&](Index k) { return surface.positions.row(surface.triangles(f, k)); };
  const Eigen::RowVector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
  return a.cross(b).stableNormalized();
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
  const Array<Side> sides = sides_on(parts, is_chosen);
  Array<Link> links;
  Array<std::pair<Index, Index>> ends;
  for (std::size_t first = 0, next = 0; first < sides.size(); first = next) {
    const Side& side = sides[first];
    const auto is_same = [&](const Side& of) { return of.low == side.low && of.high == side.high; };
    while (next < sides.size() && is_same(sides[next])) ++next;
    if (next - first == 2 && side.is_upward != sides[first + 1].is_upward) {
      const Index other = sides[first + 1].triangle;
      const bool may_be_cut = !surface.edges || cuttable.has(side.low, side.high);
      const double bend = normal_of(surface, side.triangle).dot(normal_of(surface, other));
      links.push_back({may_be_cut ? bend : uncuttable, side.low, side.high, side.triangle, other});
    } else if (next - first > 1) {
      ends.emplace_back(side.low, side.high);
    }
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.flatness > b.flatness; });
  UnionFind pieces(static_cast<Index>(surface.triangles.rows()));
  for (const Link& link : links) {
    if (!pieces.unite(link.one, link.other) && link.flatness < uncuttable) ends.emplace_back(link.low, link.high);
  }
  VertexPairs out(ssize(ends), 2);
  for (std::ptrdiff_t e = 0; e < ssize(ends); ++e) out.row(e) << ends[e].first, ends[e].second;
  return out;
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
