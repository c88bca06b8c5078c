// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaping/map_copies.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "assembly/vertex_pairs.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// std::minmax has references.
std::pair<Index, Index> sorted_pair(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

// The sides of triangles, by copies, that are edges of the surface.
VertexPairs edges_of_copies(const Surface& surface, const Triangles& copies, const Array<Index>& source_triangle) {
  Array<std::pair<Index, Index>> known;
  for (Eigen::Index e = 0; e < surface.edges->rows(); ++e) {
    known.push_back(sorted_pair((*surface.edges)(e, 0), (*surface.edges)(e, 1)));
  }
  sort_unique(known);
  Array<std::pair<Index, Index>> found;
  for (Index f = 0; f < copies.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3;
      const Index source = source_triangle[f];
      const std::pair<Index, Index> edge = sorted_pair(surface.triangles(source, c), surface.triangles(source, d));
      if (edge.first == edge.second || !std::binary_search(known.begin(), known.end(), edge)) continue;
      found.push_back(sorted_pair(copies(f, c), copies(f, d)));
    }
  }
  sort_unique(found);
  Array<Index> ends;
  for (const auto& [a, b] : found) ends.insert(ends.end(), {a, b});
  return to_vertex_pairs(ends);
}

}  // namespace

MapCopies copies_of_map(const Surface& surface, const CornerUv& corner_uv) {
  MapCopies out;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (corner_uv.middleRows(3 * f, 3).allFinite()) out.source_triangle.push_back(f);
  }
  Array<Index> corners;
  for (const Index f : out.source_triangle) {
    for (Index c = 0; c < 3; ++c) corners.push_back(3 * f + c);
  }
  const auto key = [&](Index corner) {
    return std::make_tuple(surface.triangles.data()[corner], corner_uv(corner, 0), corner_uv(corner, 1));
  };
  Array<Index> order(corners.size());
  for (Index i = 0; i < ssize(order); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::make_pair(key(corners[a]), a) < std::make_pair(key(corners[b]), b); });
  out.surface.triangles.resize(ssize(out.source_triangle), 3);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index corner = corners[order[i]];
    if (i == 0 || key(corner) != key(corners[order[i - 1]])) {
      out.source_vertex.push_back(surface.triangles.data()[corner]);
    }
    out.surface.triangles.data()[order[i]] = static_cast<Index>(out.source_vertex.size()) - 1;
  }
  out.surface.positions.resize(ssize(out.source_vertex), 3);
  for (Index v = 0; v < ssize(out.source_vertex); ++v) {
    out.surface.positions.row(v) = surface.positions.row(out.source_vertex[v]);
  }
  if (surface.edges) out.surface.edges = edges_of_copies(surface, out.surface.triangles, out.source_triangle);
  if (surface.scale.size() > 0) {
    out.surface.scale.resize(ssize(out.source_vertex));
    for (Index v = 0; v < ssize(out.source_vertex); ++v) out.surface.scale[v] = surface.scale[out.source_vertex[v]];
  }
  out.surface.may_collapse = surface.may_collapse;
  return out;
}

MapCopies part_of(const MapCopies& copies, const Array<Index>& triangles) {
  MapCopies out;
  out.surface = copies.surface;
  out.source_vertex = copies.source_vertex;
  out.surface.triangles.resize(ssize(triangles), 3);
  for (Index i = 0; i < ssize(triangles); ++i) {
    out.surface.triangles.row(i) = copies.surface.triangles.row(triangles[i]);
    out.source_triangle.push_back(copies.source_triangle[triangles[i]]);
  }
  if (copies.surface.edges) {
    Array<std::pair<Index, Index>> inside;
    for (Index f = 0; f < ssize(triangles); ++f) {
      for (int c = 0; c < 3; ++c) {
        inside.push_back(sorted_pair(out.surface.triangles(f, c), out.surface.triangles(f, (c + 1) % 3)));
      }
    }
    sort_unique(inside);
    const VertexPairs& edges = *copies.surface.edges;
    Array<Index> ends;
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
      const std::pair<Index, Index> edge = sorted_pair(edges(e, 0), edges(e, 1));
      if (!std::binary_search(inside.begin(), inside.end(), edge)) continue;
      ends.push_back(edge.first);
      ends.push_back(edge.second);
    }
    out.surface.edges = to_vertex_pairs(ends);
  }
  return out;
}

}  // namespace lsgp
