// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/border.hpp"

#include <algorithm>

namespace lsgp {

namespace {

// A border vertex with one triangle whose neighbors have more; h is the border halfedge that leads to it.
bool is_tooth(const HalfedgeMesh& mesh, const PerVertex<char>& is_corner, Index h) {
  const auto single = [&](Index v) { return mesh.rotate(mesh.outgoing[v]) == none; };
  const Index tip = mesh.target(h);
  return single(tip) && !is_corner[tip] && !single(mesh.origin(h)) && !single(mesh.origin(prev(h)));
}

PerVertex<char> flags(const HalfedgeMesh& mesh, const Array<Index>& vertices) {
  PerVertex<char> out(mesh.vertex_count(), 0);
  for (const Index v : vertices) out[v] = 1;
  return out;
}

}  // namespace

BorderConditions free_border(const HalfedgeMesh& mesh, const Array<Index>& corners) {
  const PerVertex<char> is_corner = flags(mesh, corners);
  BorderConditions out{PerVertex<char>(mesh.vertex_count(), 0), Eigen::VectorXd::Zero(mesh.vertex_count()), false};
  for (Index v = 0; v < mesh.vertex_count(); ++v) out.held[v] = mesh.loop_of_vertex[v] != none && !is_corner[v];
  out.balanced = std::find(out.held.begin(), out.held.end(), 1) == out.held.end();
  return out;
}

BorderConditions straight_border(const MetricMesh& surface, const Array<Index>& corners) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const PerVertex<char> is_corner = flags(mesh, corners);
  BorderConditions out{PerVertex<char>(mesh.vertex_count(), 0), Eigen::VectorXd::Zero(mesh.vertex_count()), true};
  for (const auto& loop : mesh.boundary_loops) {
    for (const Index v : loop) {
      const Index h = mesh.outgoing[v];
      if (!is_tooth(mesh, is_corner, h)) continue;
      // The base angles of the tooth, and what they leave at its tip.
      const double here = geometry.angle[h], there = geometry.angle[prev(h)];
      out.curvature[v] -= here;
      out.curvature[mesh.target(h)] += here + there;
      out.curvature[mesh.origin(prev(h))] -= there;
    }
  }
  return out;
}

Array<Index> corner_edges(const HalfedgeMesh& mesh, const Array<Index>& corners) {
  Array<Index> edges;
  for (const Index v : corners) {
    if (mesh.loop_of_vertex[v] == none) continue;
    Index last = mesh.outgoing[v];
    edges.push_back(last);
    while (mesh.rotate(last) != none) last = mesh.rotate(last);
    edges.push_back(prev(last));
  }
  sort_unique(edges);
  return edges;
}

Array<Index> straight_edges(const HalfedgeMesh& mesh, const Array<Index>& corners) {
  const PerVertex<char> is_corner = flags(mesh, corners);
  Array<Index> edges;
  for (const auto& loop : mesh.boundary_loops) {
    for (const Index v : loop) {
      const Index h = mesh.outgoing[v];
      const bool at_tip = mesh.twin[prev(h)] == none && is_tooth(mesh, is_corner, prev(h));
      if (is_tooth(mesh, is_corner, h))
        edges.push_back(mesh.twin[prev(h)]);
      else if (!at_tip)
        edges.push_back(h);
    }
  }
  return edges;
}

}  // namespace lsgp
