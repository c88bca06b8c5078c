// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/cut_paths.hpp"

#include <algorithm>
#include <utility>

#include "base/array.hpp"
#include "lsgp/lsgp.hpp"

namespace lsgp {

namespace {

using Edge = std::pair<Index, Index>;  // the lower vertex first

void append_edges(const VertexPairs& pairs, Array<Edge>& out) {
  for (Eigen::Index i = 0; i < pairs.rows(); ++i) out.push_back(std::minmax(pairs(i, 0), pairs(i, 1)));
}

Array<Edge> sorted_edges(const VertexPairs& pairs) {
  Array<Edge> out;
  append_edges(pairs, out);
  sort_unique(out);
  return out;
}

class PathTracer {
 public:
  // edges: sorted, each once.
  PathTracer(const Array<Edge>& edges, const std::vector<Index>& nodes) : edges_(edges), is_left_(edges.size(), 1) {
    for (const auto& [a, b] : edges) vertices_.insert(vertices_.end(), {a, b});
    sort_unique(vertices_);
    edges_at_.resize(vertices_.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      edges_at_[number_of(edges[e].first)].push_back(e);
      edges_at_[number_of(edges[e].second)].push_back(e);
    }
    for (const Array<std::size_t>& around : edges_at_) is_node_.push_back(around.size() != 2);
    for (const Index node : nodes) {
      if (std::binary_search(vertices_.begin(), vertices_.end(), node)) is_node_[number_of(node)] = 1;
    }
  }

  std::vector<std::vector<Index>> trace() {
    std::vector<std::vector<Index>> out;
    // After the paths that begin at nodes only loops without nodes are left.
    for (const bool from_nodes : {true, false}) {
      for (std::size_t v = 0; v < vertices_.size(); ++v) {
        if (from_nodes && !is_node_[v]) continue;
        for (const std::size_t e : edges_at_[v]) {
          if (is_left_[e]) out.push_back(follow(v, e));
        }
      }
    }
    return out;
  }

 private:
  // A vertex's place in the sorted list of them.
  std::size_t number_of(Index vertex) const {
    return static_cast<std::size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), vertex) - vertices_.begin());
  }

  std::vector<Index> follow(std::size_t start, std::size_t e) {
    std::vector<Index> path{vertices_[start]};
    std::size_t at = start;
    do {
      is_left_[e] = 0;
      at = number_of(edges_[e].first == vertices_[at] ? edges_[e].second : edges_[e].first);
      path.push_back(vertices_[at]);
      e = is_left_[edges_at_[at].front()] ? edges_at_[at].front() : edges_at_[at].back();
    } while (at != start && !is_node_[at]);
    return path;
  }

  const Array<Edge>& edges_;
  Array<char> is_left_;  // edges on no path yet
  Array<Index> vertices_;
  Array<Array<std::size_t>> edges_at_;  // by the indices of vertices, as nodes are
  Array<char> is_node_;
};

class CutKinds {
 public:
  CutKinds(const Surface& surface, const VertexPairs& required)
      : seams_(sorted_edges(surface.seams)), required_(sorted_edges(required)) {}

  CutPathKind of(const Edge& edge) const {
    const auto is_among = [&](const Array<Edge>& edges) {
      return std::binary_search(edges.begin(), edges.end(), edge);
    };
    if (is_among(seams_)) return CutPathKind::seam;
    return is_among(required_) ? CutPathKind::required : CutPathKind::added;
  }

  // Vertices at which edges of several kinds meet.
  Array<Index> changes(const Array<Edge>& edges) const {
    Array<std::pair<Index, CutPathKind>> found;
    for (const Edge& edge : edges) {
      for (const Index v : {edge.first, edge.second}) found.emplace_back(v, of(edge));
    }
    sort_unique(found);
    Array<Index> out;
    for (std::size_t i = 1; i < found.size(); ++i) {
      if (found[i].first == found[i - 1].first) out.push_back(found[i].first);
    }
    return out;
  }

 private:
  Array<Edge> seams_, required_;
};

}  // namespace

std::vector<std::vector<Index>> split_into_paths(const VertexPairs& edges, const std::vector<Index>& nodes) {
  return PathTracer(sorted_edges(edges), nodes).trace();
}

void trace_cut_paths(const Surface& surface, Result& result) {
  Array<Edge> edges;
  append_edges(result.cut_edges, edges);
  append_edges(surface.borders, edges);
  sort_unique(edges);
  const CutKinds kinds(surface, result.required_cuts);
  Array<Index> nodes = kinds.changes(edges);
  nodes.insert(nodes.end(), result.cones.begin(), result.cones.end());
  result.cut_paths = PathTracer(edges, nodes).trace();
  for (const std::vector<Index>& path : result.cut_paths) {
    result.cut_kinds.push_back(kinds.of(std::minmax(path[0], path[1])));
  }
}

}  // namespace lsgp
