// SPDX-License-Identifier: GPL-3.0-or-later
// Cheapest paths along the edges that cuts may follow, from many vertices at once, and the edges between the regions
// that these reach (Mehlhorn 1988).
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "cut/cut_cost.hpp"

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

// Dijkstra's algorithm over the vertices that admits(v).  reached: (n) with the starts entered; receives the others.
template <typename Admits>
void grow_paths(const HalfedgeMesh& mesh, const Geometry& geometry, PathSearch search, Admits admits,
                Array<Reached>& reached) {
  constexpr double operations_a_vertex = 100;
  std::priority_queue<PathStarts::value_type, PathStarts, std::greater<>> queue(std::greater<>(),
                                                                                std::move(search.starts));
  while (!queue.empty()) {
    checkpoint(operations_a_vertex);
    const double distance = queue.top().first;
    const Index v = queue.top().second;
    queue.pop();
    if (distance > reached[v].distance) continue;
    mesh.for_each_outgoing(v, [&](Index h) {
      const Index w = mesh.target(h);
      if (!may_cut(mesh, h) || !admits(w)) return;
      const double through = distance + cut_cost(mesh, geometry, h);
      if (!(through < std::min(reached[w].distance, search.below))) return;
      reached[w] = {through, h, reached[v].source};
      queue.emplace(through, w);
    });
  }
}

// What it costs to go from the source of an edge's one end along the edge to that of the other.
inline double cost_through(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Reached>& reached, Index h) {
  return reached[mesh.origin(h)].distance + cut_cost(mesh, geometry, h) + reached[mesh.target(h)].distance;
}

// An edge that closes a path from source to source; one halfedge each.
struct Bridge {
  double cost;
  Index halfedge;
  bool operator<(const Bridge& other) const {
    return cost != other.cost ? cost < other.cost : halfedge < other.halfedge;
  }
};

// Those that select(h), cheapest first.
template <typename Select>
Array<Bridge> sorted_bridges(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Reached>& reached,
                             Select select) {
  Array<Bridge> bridges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] < h || !may_cut(mesh, h) || !select(h)) continue;
    const double cost = cost_through(mesh, geometry, reached, h);
    if (cost < std::numeric_limits<double>::infinity()) bridges.push_back({cost, h});
  }
  std::sort(bridges.begin(), bridges.end());
  return bridges;
}

}  // namespace lsgp
