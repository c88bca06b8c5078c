// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts during their improvement: a graph of edges with the vertices that it has to reach.
#pragma once

#include "base/array.hpp"
#include "cut/cut_edges.hpp"

namespace lsgp {

using CutPath = Array<Index>;  // halfedges, one after the other

// Cut edges at each vertex.
PerVertex<Index> count_cuts(const HalfedgeMesh& mesh, const PerHalfedge<char>& is_cut);

// A surface with the edges that cuts may follow.
struct CuttableSurface : MetricMesh {
  const CutEdges& edges;
};

struct CutNetwork : CuttableSurface {
  const PerVertex<char>& is_cone;  // interior vertices that have to stay on the cuts
  PerVertex<char> is_avoided;      // boundary vertices that no cut may touch
  PerHalfedge<char> is_cut;        // on both halfedges
  PerVertex<Index> degree;         // cut edges at each vertex

  // uncut: the boundaries to avoid, or empty.
  CutNetwork(const CuttableSurface& surface, const PerVertex<char>& cones, const PerLoop<char>& uncut,
             PerHalfedge<char> cuts);

  bool is_on_border(Index v) const { return mesh.loop_of_vertex[v] != none; }
  bool holds(Index v) const { return degree[v] > 0 || is_cone[v] || (is_on_border(v) && !is_avoided[v]); }
  bool is_node(Index v) const { return is_cone[v] || is_on_border(v) || degree[v] != 2; }
  double cost(const CutPath& path) const;
  double total_cost() const;

  // The path between two nodes that contains a cut halfedge, or a closed curve without nodes.
  CutPath trace(Index h) const;
  // Calls visit(w) for the neighbors of a vertex along cuts and boundaries.
  template <typename Visit>
  void for_each_joined(Index v, Visit visit) const {
    for (const CutEdges::Edge& edge : edges.from(v)) {
      if (is_cut[edge.halfedge]) visit(edge.target);
    }
    if (!is_on_border(v)) return;
    mesh.for_each_outgoing(v, [&](Index h) {
      if (mesh.twin[h] == none) visit(mesh.target(h));
      if (mesh.twin[prev(h)] == none) visit(mesh.origin(prev(h)));
    });
  }

  void open(const CutPath& path) { set(path, 1); }
  void close(const CutPath& path) { set(path, 0); }

 private:
  void set(const CutPath& path, char cut);
};

}  // namespace lsgp
