// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_across.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

// By how much a path may bend at a vertex, of the angle around it: as far as to half of the way to the next edge where
// four meet.
constexpr double most_bend = 0.125;

// The edge that leaves a vertex most nearly at an angle from another halfedge, or from the boundary, whose sides are
// alike; both as shares of the angles around it. None without one.
Index straight_ahead(const MetricMesh& surface, Index v, Index from) {
  const auto& [mesh, geometry] = surface;
  const Index first = from == none ? mesh.outgoing[v] : from;
  double whole = 0;
  mesh.for_each_outgoing(v, [&, &geometry = geometry](Index h) { whole += geometry.angle[h]; });
  Index best = none;
  double turned = 0, least = most_bend * whole;
  for (Index h = first;;) {
    const Index following = mesh.rotate(h);
    turned += geometry.angle[h];
    if (following == none || following == first) break;
    h = following;
    const double bend = std::abs(turned - whole / 2);
    if (!may_cut(mesh, h) || !(bend < least)) continue;
    least = bend;
    best = h;
  }
  return best;
}

// From a vertex of the first boundary to the other one; empty where it does not get there.  left: edges that all paths
// may still have.
Array<Index> path_from(const MetricMesh& surface, Index start, Index& left) {
  const HalfedgeMesh& mesh = surface.mesh;
  Array<Index> out;
  for (Index h = straight_ahead(surface, start, none); h != none && left > 0; --left) {
    out.push_back(h);
    const Index v = mesh.target(h);
    if (mesh.loop_of_vertex[v] == 1) return out;
    if (mesh.loop_of_vertex[v] == 0) break;
    h = straight_ahead(surface, v, mesh.twin[h]);
  }
  return {};
}

CutGraph graph_of(const HalfedgeMesh& mesh, const Array<Index>& halfedges) {
  PerHalfedge<char> is_cut(mesh.halfedge_count(), 0);
  for (const Index h : halfedges) is_cut[h] = is_cut[mesh.twin[h]] = 1;
  return trace_cuts(mesh, PerVertex<char>(mesh.vertex_count(), 0), std::move(is_cut));
}

struct ClosedPath {
  Array<Index> halfedges;
  double cost = 0;
};

// Those that go straight ahead and pass no vertex twice, through vertices of quads alone.
Array<ClosedPath> closed_paths(const MetricMesh& surface) {
  constexpr Index most_edges = 8;  // of four quads with their diagonals
  const HalfedgeMesh& mesh = surface.mesh;
  PerVertex<Index> degree(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) ++degree[mesh.origin(h)];
  PerHalfedge<char> is_passed(mesh.halfedge_count(), 0);
  PerVertex<Index> last_path(mesh.vertex_count(), none);
  Array<ClosedPath> out;
  Index number = 0;
  for (Index first = 0; first < mesh.halfedge_count(); ++first) {
    if (is_passed[first] || !may_cut(mesh, first)) continue;
    ClosedPath path;
    ++number;
    bool is_simple = true;
    Index h = first;
    do {
      is_passed[h] = is_passed[mesh.twin[h]] = 1;
      path.halfedges.push_back(h);
      path.cost += cut_cost(surface, h);
      const Index v = mesh.target(h);
      is_simple &= last_path[v] != number;
      last_path[v] = number;
      h = degree[v] <= most_edges ? straight_ahead(surface, v, mesh.twin[h]) : none;
    } while (h != none && h != first && !is_passed[h]);
    if (is_simple && h == first) out.push_back(std::move(path));
  }
  return out;
}

}  // namespace

std::optional<CutGraph> cut_around(const MetricMesh& torus) {
  const HalfedgeMesh& mesh = torus.mesh;
  const Array<ClosedPath> paths = closed_paths(torus);
  PerVertex<Array<Index>> through(mesh.vertex_count());
  for (Index i = 0; i < ssize(paths); ++i) {
    for (const Index h : paths[i].halfedges) through[mesh.target(h)].push_back(i);
  }
  Array<std::pair<Index, Index>> crossings;
  for (const Array<Index>& own : through) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t k = i + 1; k < own.size(); ++k) crossings.emplace_back(own[i], own[k]);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  const std::pair<Index, Index>* best = nullptr;
  double least = 0;
  for (std::size_t i = 0, end = 0; i < crossings.size(); i = end) {
    while (end < crossings.size() && crossings[end] == crossings[i]) ++end;
    const auto& [one, other] = crossings[i];
    const double cost = paths[one].cost + paths[other].cost;
    if (end - i > 1 || (best != nullptr && cost >= least)) continue;
    best = &crossings[i];
    least = cost;
  }
  if (best == nullptr) return std::nullopt;
  Array<Index> cut = paths[best->first].halfedges;
  const Array<Index>& other = paths[best->second].halfedges;
  cut.insert(cut.end(), other.begin(), other.end());
  return graph_of(mesh, cut);
}

std::optional<CutGraph> cut_across(const MetricMesh& ring) {
  const HalfedgeMesh& mesh = ring.mesh;
  Array<Index> best;
  double least = 0;
  Index left = mesh.vertex_count();  // rows of quads have no vertex in common
  for (const Index v : mesh.boundary_loops.front()) {
    Array<Index> path = path_from(ring, v, left);
    if (path.empty()) continue;
    double cost = 0;
    for (const Index h : path) cost += cut_cost(ring, h);
    if (!best.empty() && cost >= least) continue;
    least = cost;
    best = std::move(path);
  }
  if (best.empty()) return std::nullopt;
  return graph_of(mesh, best);
}

}  // namespace lsgp
