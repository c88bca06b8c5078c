// SPDX-License-Identifier: GPL-3.0-or-later
// Cheapest paths along the edges that cuts may follow, from many vertices at once, and the edges between the regions
// that these reach (Mehlhorn 1988).
#pragma once

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "cut/bucket_queue.hpp"
#include "cut/cut_edges.hpp"

namespace lsgp {

// How a vertex is reached.
struct Reached {
  double distance = std::numeric_limits<double>::infinity();
  Index by = none;      // the halfedge that leads there, none at a source
  Index source = none;  // none where no path leads
};

// Vertices from which paths start, at the distances they have already.
using PathStarts = std::vector<std::pair<double, Index>>;

// Where paths start, and the distance below which they are followed.
struct PathSearch {
  PathStarts starts;
  double below = std::numeric_limits<double>::infinity();
};

// Dijkstra's algorithm over the vertices that admits(v).  reached: with the starts entered; receives the others.
template <typename Admits>
void grow_paths(const CutEdges& edges, const PathSearch& search, Admits admits, PerVertex<Reached>& reached) {
  constexpr double operations_a_vertex = 100;
  constexpr std::size_t likely_read_soon = 4;  // vertices
  BucketQueue queue(edges.usual_cost() / 4);
  for (const auto& [distance, v] : search.starts) queue.push(distance, v);
  while (!queue.empty()) {
    checkpoint(operations_a_vertex);
    const auto [distance, v] = queue.pop();
    const Index soon = queue.ahead(likely_read_soon);
    if (soon != none) edges.prefetch(soon);
    const Reached from = reached[v];
    if (distance > from.distance) continue;
    for (const CutEdges::Edge& edge : edges.from(v)) {
      const double through = distance + edge.cost;
      if (!(through < std::min(reached[edge.target].distance, search.below)) || !admits(edge.target)) continue;
      reached[edge.target] = {through, edge.halfedge, from.source};
      queue.push(through, edge.target);
    }
  }
}

// An edge that closes a path from source to source.
struct Bridge {
  double cost;      // of that path
  Index halfedge;   // the first one of the edge
  Index low, high;  // the sources
  bool operator<(const Bridge& other) const {
    return cost != other.cost ? cost < other.cost : halfedge < other.halfedge;
  }
};

// Those between reached vertices v and targets of edges from them that select(v, edge), in no particular order.
template <typename Select>
Array<Bridge> find_bridges(const HalfedgeMesh& mesh, const CutEdges& edges, const PerVertex<Reached>& reached,
                           Select select) {
  Array<Bridge> bridges;
  for (Index v = 0; v < edges.vertex_count(); ++v) {
    const Reached& a = reached[v];
    if (a.source == none) continue;
    for (const CutEdges::Edge& edge : edges.from(v)) {
      if (edge.target < v) continue;
      const Reached& b = reached[edge.target];
      if (b.source == none || !select(v, edge)) continue;
      const Index h = std::min(edge.halfedge, mesh.twin[edge.halfedge]);
      const auto& [first, second] = mesh.origin(h) == v ? std::tie(a, b) : std::tie(b, a);
      bridges.push_back({first.distance + edge.cost + second.distance, h, std::min(a.source, b.source),
                         std::max(a.source, b.source)});
    }
  }
  return bridges;
}

// The cheapest of the bridges between each two sources, which are vertices; cheapest first.
Array<Bridge> cheapest_of_pairs(const Array<Bridge>& bridges, Index vertex_count);

}  // namespace lsgp
