// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_network.hpp"

#include <utility>

namespace lsgp {

PerVertex<Index> count_cuts(const HalfedgeMesh& mesh, const PerHalfedge<char>& is_cut) {
  PerVertex<Index> degree(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) degree[mesh.origin(h)] += is_cut[h];
  return degree;
}

CutNetwork::CutNetwork(const CuttableSurface& surface, const PerVertex<char>& cones, const PerLoop<char>& uncut,
                       PerHalfedge<char> cuts)
    : CuttableSurface(surface),
      is_cone(cones),
      is_avoided(surface.mesh.vertex_count(), 0),
      is_cut(std::move(cuts)),
      degree(count_cuts(surface.mesh, is_cut)) {
  for (std::size_t loop = 0; loop < uncut.size(); ++loop) {
    if (!uncut[loop]) continue;
    for (const Index v : mesh.boundary_loops[loop]) is_avoided[v] = 1;
  }
}

double CutNetwork::cost(const CutPath& path) const {
  double out = 0;
  for (const Index h : path) out += cut_cost(*this, h);
  return out;
}

double CutNetwork::total_cost() const {
  double out = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) out += is_cut[h] && mesh.twin[h] > h ? cut_cost(*this, h) : 0;
  return out;
}

CutPath CutNetwork::trace(Index h) const {
  // The other cut at a vertex that has two.
  const auto cut_after = [&](Index before) {
    Index out = none;
    mesh.for_each_outgoing(mesh.target(before), [&](Index g) {
      if (is_cut[g] && g != mesh.twin[before]) out = g;
    });
    return out;
  };
  const Index first = h;
  while (!is_node(mesh.origin(h))) {
    h = mesh.twin[cut_after(mesh.twin[h])];
    if (h == first) break;
  }
  CutPath path{h};
  const Index tail = mesh.origin(h);
  while (!is_node(mesh.target(h)) && mesh.target(h) != tail) {
    h = cut_after(h);
    path.push_back(h);
  }
  return path;
}

void CutNetwork::set(const CutPath& path, char cut) {
  const Index change = cut ? 1 : -1;
  for (const Index h : path) {
    is_cut[h] = is_cut[mesh.twin[h]] = cut;
    degree[mesh.origin(h)] += change;
    degree[mesh.target(h)] += change;
  }
}

}  // namespace lsgp
