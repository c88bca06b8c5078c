// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_across.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

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
  PerHalfedge<char> is_cut(mesh.halfedge_count(), 0);
  for (const Index h : best) is_cut[h] = is_cut[mesh.twin[h]] = 1;
  return trace_cuts(mesh, PerVertex<char>(mesh.vertex_count(), 0), std::move(is_cut));
}

}  // namespace lsgp
