// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces/piece_graph.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

constexpr double least_piece_area = 0.004;  // of the surface
constexpr double operations_a_border = 20;
constexpr double operations_a_path = 20;  // of finding the open ones

// Merges small pieces across paths that are not cut.
class PieceMerger {
 public:
  PieceMerger(const MetricMesh& surface, const PerHalfedge<char>& is_cut, PerHalfedge<char>& network)
      : mesh_(surface.mesh),
        is_cut_(is_cut),
        network_(network),
        least_area_(least_piece_area * surface.geometry.total_area),
        area_(label_parts(surface.mesh, network, piece_), 0),
        groups_(static_cast<Index>(area_.size())) {
    const HalfedgeMesh& mesh = surface.mesh;
    const Geometry& geometry = surface.geometry;
    for (Index f = 0; f < mesh.triangle_count(); ++f) area_[piece_[f]] += geometry.area[f];
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (!is_candidate(h) || mesh.twin[h] < h) continue;
      borders_[std::minmax(piece_[h / 3], piece_[mesh.twin[h] / 3])] += geometry.length[h];
    }
  }

  // The smallest first, with the neighbor of the longest shared border. Paths inside pieces leave the network.
  void merge_small() {
    for (Index smallest = find_smallest(); smallest != none; smallest = find_smallest()) {
      checkpoint(operations_a_border * static_cast<double>(borders_.size()));
      const Index other = nearest_to(smallest);
      const double both = other == none ? least_area_ : area_[smallest] + area_[other];  // a lone piece stays
      if (other != none) groups_.unite(smallest, other);
      area_[groups_.find(smallest)] = both;
    }
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (is_candidate(h) && groups_.find(piece_[h / 3]) == groups_.find(piece_[mesh_.twin[h] / 3])) network_[h] = 0;
    }
  }

 private:
  bool is_candidate(Index h) const { return network_[h] && !is_cut_[h]; }

  // `none` if all are large enough.
  Index find_smallest() {
    Index smallest = none;
    for (Index g = 0; g < ssize(area_); ++g) {
      if (groups_.find(g) != g || area_[g] >= least_area_) continue;
      if (smallest == none || area_[g] < area_[smallest]) smallest = g;
    }
    return smallest;
  }

  Index nearest_to(Index group) {
    std::map<Index, double> shared;  // with other groups
    for (const auto& [pieces, length] : borders_) {
      const Index a = groups_.find(pieces.first), b = groups_.find(pieces.second);
      if (a != b && (a == group || b == group)) shared[a == group ? b : a] += length;
    }
    const auto longest = std::max_element(shared.begin(), shared.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    return longest == shared.end() ? none : longest->first;
  }

  const HalfedgeMesh& mesh_;
  const PerHalfedge<char>& is_cut_;
  PerHalfedge<char>& network_;
  const double least_area_;
  PerTriangle<Index> piece_;
  PerPart<double> area_;  // of the groups
  UnionFind groups_;
  std::map<std::pair<Index, Index>, double> borders_;  // length by pieces, the lower first
};

class Builder {
 public:
  Builder(const MetricMesh& surface, const ComponentMap& map, double resolution)
      : mesh_(surface.mesh),
        map_(map),
        corners_(at_corners(map.cut_mesh, map.position)),
        resolution_(resolution),
        is_cone_(surface.mesh.vertex_count(), 0),
        node_of_(surface.mesh.vertex_count(), none) {
    for (const Index v : map.cones) is_cone_[v] = 1;
  }

  PieceGraph build(PerHalfedge<char> network) {
    graph_.boundary.resize(label_parts(mesh_, network, graph_.piece_of));
    for (Cut& path : trace_cuts(mesh_, is_cone_, std::move(network)).cuts) add(std::move(path));
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (mesh_.twin[h] == none) boundary_of(h).push_back({corners_[h], corners_[next(h)]});
    }
    return std::move(graph_);
  }

 private:
  Array<PieceGraph::Side>& boundary_of(Index h) { return graph_.boundary[graph_.piece_of[h / 3]]; }

  Index node(Index v) {
    if (node_of_[v] == none) {
      node_of_[v] = static_cast<Index>(graph_.is_end.size());
      graph_.is_end.push_back(is_cone_[v] || mesh_.loop_of_vertex[v] != none);
    }
    return node_of_[v];
  }

  void add(Cut traced) {
    const Index first = traced.halfedges.front(), twin = mesh_.twin[first], cut = map_.cut_graph.cut_of[first];
    PieceGraph::Path path{{},
                          graph_.piece_of[first / 3],
                          graph_.piece_of[twin / 3],
                          {},
                          0,
                          {node(traced.tail), node(traced.head)},
                          cut != none};
    if (cut != none) {
      const double angle = (map_.cut_graph.runs_forward[first] ? 1 : -1) * (*map_.rotation)[cut];
      path.across = {angle, corners_[next(twin)] - std::polar(1.0, angle) * corners_[first]};
    }
    add_boundaries(traced.halfedges);
    path.halfedges = std::move(traced.halfedges);
    graph_.paths.push_back(std::move(path));
  }

  // Both sides leave out the same vertices, so that they meet.
  void add_boundaries(const Array<Index>& halfedges) {
    Index begin = none;
    for (const Index h : halfedges) {
      if (begin == none) begin = h;
      const Complex tail = corners_[begin], head = corners_[next(h)];
      if (h != halfedges.back() && std::abs(head - tail) < resolution_) continue;
      boundary_of(h).push_back({tail, head});
      boundary_of(mesh_.twin[h]).push_back({corners_[mesh_.twin[h]], corners_[next(mesh_.twin[begin])]});
      begin = none;
    }
  }

  const HalfedgeMesh& mesh_;
  const ComponentMap& map_;
  const Eigen::VectorXcd corners_;
  const double resolution_;
  PerVertex<char> is_cone_;
  PerVertex<Index> node_of_;
  PieceGraph graph_;
};

}  // namespace

PieceGraph build_piece_graph(const MetricMesh& surface, const ComponentMap& map, PerHalfedge<char> network,
                             double resolution) {
  PieceMerger(surface, map.cut_graph.is_cut, network).merge_small();
  return Builder(surface, map, resolution).build(std::move(network));
}

PerPart<Array<Index>> paths_of_pieces(const PieceGraph& graph) {
  PerPart<Array<Index>> out(graph.piece_count());
  for (Index p = 0; p < ssize(graph.paths); ++p) {
    const PieceGraph::Path& path = graph.paths[p];
    if (path.left == path.right) continue;
    for (const Index piece : {path.left, path.right}) out[piece].push_back(p);
  }
  return out;
}

Array<char> open_paths(const PieceGraph& graph, const Array<char>& in_tree) {
  Array<char> open(in_tree.size(), 0);
  Array<Index> degree(graph.is_end.size(), 0), sum(graph.is_end.size(), 0);  // of the open paths at each node
  const auto change = [&](Index p, Index by) {
    open[p] = by > 0;
    for (const Index node : graph.paths[p].nodes) {
      degree[node] += by;
      sum[node] += by * p;
    }
  };
  for (Index p = 0; p < ssize(open); ++p) {
    if (!in_tree[p]) change(p, 1);
  }
  for (Index node = 0; node < ssize(degree); ++node) {
    for (Index at = node; degree[at] == 1 && !graph.is_end[at];) {
      const Index last = sum[at];
      change(last, -1);
      at = graph.paths[last].nodes[graph.paths[last].nodes[0] == at];
    }
  }
  checkpoint(operations_a_path * static_cast<double>(open.size()));
  return open;
}

double cost_of_cuts(const PieceGraph& graph, const Array<char>& open) {
  double out = 0;
  for (std::size_t p = 0; p < open.size(); ++p) out += open[p] ? graph.paths[p].cost : 0;
  return out;
}

PerHalfedge<char> cuts_along(const PieceGraph& graph, const HalfedgeMesh& mesh, const Array<char>& open) {
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  for (std::size_t p = 0; p < open.size(); ++p) {
    if (!open[p]) continue;
    for (const Index h : graph.paths[p].halfedges) out[h] = out[mesh.twin[h]] = 1;
  }
  return out;
}

void price_paths(const MetricMesh& costs, PieceGraph& graph) {
  for (PieceGraph::Path& path : graph.paths) {
    path.cost = 0;
    for (const Index h : path.halfedges) path.cost += cut_cost(costs, h);
  }
}

}  // namespace lsgp
