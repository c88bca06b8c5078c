// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces/candidate_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "cut/shortest_paths.hpp"

namespace lsgp {

namespace {

constexpr double stretch_length = 0.15;  // of the square root of the surface's area

// Numbers the stretches of the cuts and of the boundaries that these reach.
class Stretches {
 public:
  Stretches(const MetricMesh& surface, const CutGraph& cut_graph)
      : geometry_(surface.geometry),
        longest_(stretch_length * std::sqrt(surface.geometry.total_area)),
        of_(surface.mesh.vertex_count(), none) {
    const HalfedgeMesh& mesh = surface.mesh;
    for (const Cut& cut : cut_graph.cuts) {
      for (const Index end : {cut.tail, cut.head}) {
        if (of_[end] == none) of_[end] = count_++;
      }
    }
    PerLoop<char> is_reached(mesh.boundary_loops.size(), 0);
    for (const Cut& cut : cut_graph.cuts) {
      start();
      for (const Index h : cut.halfedges) add(mesh.origin(h), h);
      for (const Index end : {cut.tail, cut.head}) {
        if (mesh.loop_of_vertex[end] != none) is_reached[mesh.loop_of_vertex[end]] = 1;
      }
    }
    for (std::size_t loop = 0; loop < mesh.boundary_loops.size(); ++loop) {
      if (!is_reached[loop]) continue;
      start();
      for (const Index v : mesh.boundary_loops[loop]) add(v, mesh.outgoing[v]);
    }
  }

  Index of(Index v) const { return of_[v]; }

 private:
  void start() {
    ++count_;
    length_ = 0;
  }
  void add(Index v, Index h) {
    if (of_[v] == none) of_[v] = count_ - 1;
    length_ += geometry_.length[h];
    if (length_ > longest_) start();
  }

  const Geometry& geometry_;
  const double longest_;
  PerVertex<Index> of_;  // none elsewhere
  Index count_ = 0;
  double length_ = 0;
};

}  // namespace

PerHalfedge<char> find_candidate_cuts(const MetricMesh& surface, const CutGraph& cut_graph) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Stretches stretches(surface, cut_graph);
  PerVertex<Reached> reached(mesh.vertex_count());
  PathStarts starts;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (stretches.of(v) == none) continue;
    reached[v] = {0, none, v};
    starts.emplace_back(0.0, v);
  }
  // Boundaries that no cut reaches are left as they are.
  const auto admits = [&](Index v) { return mesh.loop_of_vertex[v] == none || stretches.of(v) != none; };
  const CutEdges edges(surface);
  grow_paths(edges, {std::move(starts)}, admits, reached);
  PerHalfedge<char> out = cut_graph.is_cut;
  std::set<std::pair<Index, Index>> joined;
  const auto stretch_at = [&](Index v) { return stretches.of(reached[v].source); };
  const auto joins = [&](Index v, const CutEdges::Edge& edge) {
    return !cut_graph.is_cut[edge.halfedge] && stretch_at(v) != stretch_at(edge.target);
  };
  Array<Bridge> bridges = find_bridges(mesh, edges, reached, joins);
  std::sort(bridges.begin(), bridges.end());
  for (const Bridge& bridge : bridges) {
    const Index h = bridge.halfedge, ends[] = {mesh.origin(h), mesh.target(h)};
    if (!joined.insert(std::minmax(stretch_at(ends[0]), stretch_at(ends[1]))).second) continue;
    out[h] = out[mesh.twin[h]] = 1;
    for (const Index end : ends) {
      for (Index by = reached[end].by; by != none && !out[by]; by = reached[mesh.origin(by)].by) {
        out[by] = out[mesh.twin[by]] = 1;
      }
    }
  }
  return out;
}

}  // namespace lsgp
