// SPDX-License-Identifier: GPL-3.0-or-later
// The cut graph (the paper's section 4.1): cuts that join all cones and boundary loops and open every handle.
#pragma once

#include "base/array.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct CutKind;
template <typename T>
using PerCut = ArrayPer<CutKind, T>;

// A path of halfedges from node to node. Its left side is the copy in the triangles of its halfedges.
struct Cut {
  Array<Index> halfedges;
  Index tail = none, head = none;  // vertices at its ends: cones, junctions or points of a boundary
};

struct CutGraph {
  Array<Cut> cuts;
  PerHalfedge<char> is_cut;        // on both halfedges of a cut edge
  PerHalfedge<Index> cut_of;       // the cut a halfedge belongs to, none off the cuts
  PerHalfedge<char> runs_forward;  // the halfedge points from its cut's tail to its head
};

// One multi-source Dijkstra grows a region around every cone and boundary loop; the minimum spanning tree over the
// edges between regions is the minimum spanning tree of all shortest paths (Mehlhorn 1988), and its paths merge into
// a tree by construction. Each handle adds two loops that are left over by a spanning tree of the triangles
// (tree-cotree, Erickson and Whittlesey 2005). Seam edges cost nothing, and seam networks are joined like cones.
// interior_cones: vertices not on a boundary.  uncut: boundary loops that no cut has to reach, or empty; cuts
// keep clear of them. Throws CUTS_BLOCKED with the component's own vertex numbers.
CutGraph connect_cones(const MetricMesh& surface, const Array<Index>& interior_cones, const PerLoop<char>& uncut);

// Vertices that cuts can join have the same number: the least of them. Borders are joined by themselves.
PerVertex<Index> find_cut_networks(const HalfedgeMesh& mesh);

// The cut graph that is left where some cones inside are none any more: only those given still have to be reached.
CutGraph keep_cones(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const Array<Index>& interior_cones);

// Of all cuts, as `cut_cost` has it.
double cost_of(const MetricMesh& surface, const CutGraph& cut_graph);

// One of each cut edge, cut by cut.
Array<Index> halfedges_of(const CutGraph& cut_graph);

// Which vertices lie on a cut.
PerVertex<char> on_cuts(const HalfedgeMesh& mesh, const CutGraph& cut_graph);

// Divides marked edges into cuts.  is_cut: on both halfedges; is_node: vertices at which a cut ends besides
// boundary vertices and junctions. Closed curves without a node are cut at their lowest vertex.
CutGraph trace_cuts(const HalfedgeMesh& mesh, const PerVertex<char>& is_node, PerHalfedge<char> is_cut);

}  // namespace lsgp
