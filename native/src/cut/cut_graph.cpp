// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_graph.hpp"

#include <algorithm>
#include <utility>

#include "base/text.hpp"
#include "base/union_find.hpp"
#include "cut/cut_cost.hpp"
#include "cut/key_path_exchange.hpp"
#include "cut/shortest_paths.hpp"

namespace lsgp {

namespace {

// One vertex of every connected network of seam edges that a cut may follow.
Array<Index> find_seam_networks(const HalfedgeMesh& mesh) {
  UnionFind networks(mesh.vertex_count());
  PerVertex<char> on_seam(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.seam[h] || !may_cut(mesh, h)) continue;
    networks.unite(mesh.origin(h), mesh.target(h));
    on_seam[mesh.origin(h)] = on_seam[mesh.target(h)] = 1;
  }
  Array<Index> out;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (on_seam[v] && networks.find(v) == v) out.push_back(v);
  }
  return out;
}

// Shortest paths from the sources: cones by themselves, a boundary loop's vertices together, and a seam network, along
// which a path costs nothing. That networks are joined like cones keeps the regions that seams close off in one piece
// each; where a cut does not need a network, its branch ends in no cone and is pruned.
struct Forest {
  PerVertex<Reached> reached;
  PerVertex<Index> region;  // of the source, none where no path leads
  Index region_count = 0;
  Index required_count = 0;  // the first regions, of loops and cones, have to be joined; seam networks may be
};

Forest grow_forest(const HalfedgeMesh& mesh, const CutEdges& edges, const Array<Index>& interior_cones,
                   const PerLoop<char>& uncut) {
  const Index n = mesh.vertex_count();
  Forest forest{PerVertex<Reached>(n), PerVertex<Index>(n, none), 0, 0};
  PerVertex<char> is_avoided(n, 0);
  PathStarts starts;
  const auto add_source = [&](Index v, Index region) {
    forest.reached[v] = {0, none, v};
    forest.region[v] = region;
    starts.emplace_back(0.0, v);
  };
  for (std::size_t i = 0; i < mesh.boundary_loops.size(); ++i) {
    const bool avoided = !uncut.empty() && uncut[i];
    for (const Index v : mesh.boundary_loops[i]) {
      if (avoided)
        is_avoided[v] = 1;
      else
        add_source(v, forest.region_count);
    }
    forest.region_count += !avoided;
  }
  for (const Index v : interior_cones) add_source(v, forest.region_count++);
  forest.required_count = forest.region_count;
  for (const Index v : find_seam_networks(mesh)) {
    if (forest.region[v] == none && !is_avoided[v]) add_source(v, forest.region_count++);
  }
  if (forest.region_count == 0) add_source(0, forest.region_count++);  // a closed surface with handles alone
  grow_paths(edges, {std::move(starts)}, [&](Index v) { return !is_avoided[v]; }, forest.reached);
  for (Index v = 0; v < n; ++v) {
    const Index source = forest.reached[v].source;
    if (source != none) forest.region[v] = forest.region[source];
  }
  return forest;
}

// The minimum spanning tree of the regions, as far as cuttable edges connect them.
Array<Index> span_regions(const HalfedgeMesh& mesh, const CutEdges& edges, const Forest& forest) {
  const auto between_regions = [&](Index v, const CutEdges::Edge& edge) {
    return forest.region[v] != forest.region[edge.target];
  };
  Array<Bridge> bridges = find_bridges(mesh, edges, forest.reached, between_regions);
  std::sort(bridges.begin(), bridges.end());
  UnionFind regions(forest.region_count);
  Array<Index> tree;
  for (const Bridge& bridge : bridges) {
    if (regions.unite(forest.region[bridge.low], forest.region[bridge.high])) tree.push_back(bridge.halfedge);
  }
  return tree;
}

// How many of the regions that have to be joined the tree joins to the first.
Index count_joined(const HalfedgeMesh& mesh, const Forest& forest, const Array<Index>& tree) {
  UnionFind regions(forest.region_count);
  for (const Index h : tree) regions.unite(forest.region[mesh.origin(h)], forest.region[mesh.target(h)]);
  Index joined = 0;
  for (Index region = 0; region < forest.required_count; ++region) joined += regions.find(region) == regions.find(0);
  return joined;
}

// The 2 genus edges that neither the spanning tree of the vertices nor one of the triangles uses. The tree of the
// triangles takes the edges with the longest loops, so the shortest loops are left; diagonals, and edges that cuts
// cannot reach, are always crossed.
Array<Index> find_handle_edges(const HalfedgeMesh& mesh, const CutEdges& edges, const Forest& forest,
                               const Array<Index>& spanning) {
  PerHalfedge<char> in_tree(mesh.halfedge_count(), 0);
  const auto mark = [&](Index h) { in_tree[h] = in_tree[mesh.twin[h]] = 1; };
  for (const Reached& there : forest.reached) {
    if (there.by != none) mark(there.by);
  }
  for (const Index h : spanning) mark(h);
  UnionFind triangles(mesh.triangle_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const bool reached = forest.region[mesh.origin(h)] != none && forest.region[mesh.target(h)] != none;
    if (mesh.twin[h] != none && !(mesh.cuttable[h] && reached)) triangles.unite(h / 3, mesh.twin[h] / 3);
  }
  Array<Index> left_over;
  const auto is_left = [&](Index, const CutEdges::Edge& edge) { return !in_tree[edge.halfedge]; };
  Array<Bridge> candidates = find_bridges(mesh, edges, forest.reached, is_left);
  std::sort(candidates.begin(), candidates.end());
  for (auto bridge = candidates.rbegin(); bridge != candidates.rend(); ++bridge) {
    if (!triangles.unite(bridge->halfedge / 3, mesh.twin[bridge->halfedge] / 3)) left_over.push_back(bridge->halfedge);
  }
  if (static_cast<int>(left_over.size()) != 2 * mesh.genus) {
    throw Error(Code::cuts_blocked, concat("The edges a cut may follow do not open the surface's ",
                                           count(mesh.genus, "handle", "handles"), ". Allow more edges to be cut."));
  }
  return left_over;
}

// Marks an edge and the forest's paths from both its ends to their sources.
void mark_through(const HalfedgeMesh& mesh, const Forest& forest, Index bridge, PerHalfedge<char>& is_cut) {
  is_cut[bridge] = is_cut[mesh.twin[bridge]] = 1;
  for (const Index end : {mesh.origin(bridge), mesh.target(bridge)}) {
    for (Index h = forest.reached[end].by; h != none && !is_cut[h]; h = forest.reached[mesh.origin(h)].by) {
      is_cut[h] = is_cut[mesh.twin[h]] = 1;
    }
  }
}

// Prunes dangling branches, which a seam network without cones can leave.
PerHalfedge<char> prune(const HalfedgeMesh& mesh, const PerVertex<char>& is_cone, PerHalfedge<char> is_cut) {
  PerVertex<Index> degree = count_cuts(mesh, is_cut);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (Index at = v; degree[at] == 1 && !is_cone[at] && mesh.loop_of_vertex[at] == none;) {
      Index end = none;
      mesh.for_each_outgoing(at, [&](Index h) {
        if (is_cut[h]) end = h;
      });
      is_cut[end] = is_cut[mesh.twin[end]] = 0;
      --degree[at];
      at = mesh.target(end);
      --degree[at];
    }
  }
  return is_cut;
}

PerVertex<char> mark_vertices(const HalfedgeMesh& mesh, const Array<Index>& vertices) {
  PerVertex<char> out(mesh.vertex_count(), 0);
  for (const Index v : vertices) out[v] = 1;
  return out;
}

}  // namespace

Array<Index> halfedges_of(const CutGraph& cut_graph) {
  Array<Index> out;
  for (const Cut& cut : cut_graph.cuts) out.insert(out.end(), cut.halfedges.begin(), cut.halfedges.end());
  return out;
}

PerVertex<char> on_cuts(const HalfedgeMesh& mesh, const CutGraph& cut_graph) {
  PerVertex<char> out(mesh.vertex_count(), 0);
  for (const Cut& cut : cut_graph.cuts) {
    out[cut.head] = 1;
    for (const Index h : cut.halfedges) out[mesh.origin(h)] = 1;
  }
  return out;
}

PerVertex<Index> find_cut_networks(const HalfedgeMesh& mesh) {
  UnionFind networks(mesh.vertex_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (may_cut(mesh, h)) networks.unite(mesh.origin(h), mesh.target(h));
  }
  for (const auto& loop : mesh.boundary_loops) {
    for (const Index v : loop) networks.unite(loop.front(), v);
  }
  PerVertex<Index> out(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) out[v] = networks.find(v);
  return out;
}

CutGraph connect_cones(const MetricMesh& surface, const Array<Index>& interior_cones, const PerLoop<char>& uncut) {
  const HalfedgeMesh& mesh = surface.mesh;
  const bool avoids = std::find(uncut.begin(), uncut.end(), 1) != uncut.end();
  PerLoop<char> avoided = avoids ? uncut : PerLoop<char>();
  const CutEdges edges(surface);
  Forest forest = grow_forest(mesh, edges, interior_cones, avoided);
  Array<Index> tree = span_regions(mesh, edges, forest);
  if (avoids && count_joined(mesh, forest, tree) < forest.required_count) {
    // Cones or loops that only holes surround: cuts have to use the holes' borders after all.
    avoided.clear();
    forest = grow_forest(mesh, edges, interior_cones, avoided);
    tree = span_regions(mesh, edges, forest);
  }
  const Index joined = count_joined(mesh, forest, tree);
  if (joined < forest.required_count) {
    throw Error(Code::cuts_blocked,
                concat("The edges a cut may follow join only ", joined, " of ", forest.required_count,
                       " cones and boundary loops. Allow more edges to be cut."));
  }
  PerHalfedge<char> is_cut(mesh.halfedge_count(), 0);
  for (const Index h : tree) mark_through(mesh, forest, h, is_cut);
  if (mesh.genus > 0) {
    for (const Index h : find_handle_edges(mesh, edges, forest, tree)) mark_through(mesh, forest, h, is_cut);
  }
  const PerVertex<char> is_cone = mark_vertices(mesh, interior_cones);
  CutNetwork network({surface, edges}, is_cone, avoided, prune(mesh, is_cone, std::move(is_cut)));
  shorten_cuts(network);
  return trace_cuts(mesh, is_cone, prune(mesh, is_cone, std::move(network.is_cut)));
}

CutGraph keep_cones(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const Array<Index>& interior_cones) {
  const PerVertex<char> is_cone = mark_vertices(mesh, interior_cones);
  return trace_cuts(mesh, is_cone, prune(mesh, is_cone, cut_graph.is_cut));
}

double cost_of(const MetricMesh& surface, const CutGraph& cut_graph) {
  double out = 0;
  for (const Cut& cut : cut_graph.cuts) {
    for (const Index h : cut.halfedges) out += cut_cost(surface, h);
  }
  return out;
}

CutGraph trace_cuts(const HalfedgeMesh& mesh, const PerVertex<char>& is_node, PerHalfedge<char> is_cut) {
  const PerVertex<Index> degree = count_cuts(mesh, is_cut);
  CutGraph graph;
  graph.is_cut = std::move(is_cut);
  graph.cut_of.assign(mesh.halfedge_count(), none);
  graph.runs_forward.assign(mesh.halfedge_count(), 0);
  const auto ends_at = [&](Index v) { return is_node[v] || mesh.loop_of_vertex[v] != none || degree[v] != 2; };
  const auto follow = [&](Index h) {
    Cut cut;
    cut.tail = mesh.origin(h);
    while (true) {
      cut.halfedges.push_back(h);
      graph.cut_of[h] = graph.cut_of[mesh.twin[h]] = static_cast<Index>(graph.cuts.size());
      graph.runs_forward[h] = 1;
      const Index v = mesh.target(h), back = mesh.twin[h];
      if (ends_at(v) || v == cut.tail) {
        cut.head = v;
        break;
      }
      mesh.for_each_outgoing(v, [&](Index out) {
        if (graph.is_cut[out] && out != back) h = out;
      });
    }
    graph.cuts.push_back(std::move(cut));
  };
  for (const bool closed_curves : {false, true}) {
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (degree[v] == 0 || !(closed_curves || ends_at(v))) continue;
      mesh.for_each_outgoing(v, [&](Index h) {
        if (graph.is_cut[h] && graph.cut_of[h] == none) follow(h);
      });
    }
  }
  return graph;
}

}  // namespace lsgp
