// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_regions.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace lsgp {

namespace {

// A path between two regions is cheapest where it crosses from one to the other within half its cost from both ends, so
// that nothing beyond matters; a little more, for rounding.
double half_of(double cost) { return (0.5 + 1e-9) * cost; }

}  // namespace

CutRegions::CutRegions(const CutNetwork& network)
    : network_(network), again_(network.mesh.vertex_count()), redone_(network.mesh.vertex_count(), 0) {}

void CutRegions::update(double below) {
  was_cut_ = network_.is_cut;
  sources_.clear();
  for (Index v = 0; v < network_.mesh.vertex_count(); ++v) {
    if (network_.holds(v)) sources_.push_back(v);
  }
  if (below > below_) {
    grow(below);
  } else {
    regrow_changed();
    list();
  }
}

void CutRegions::grow(double below) {
  below_ = below;
  reached_.assign(network_.mesh.vertex_count(), {});
  PathStarts starts;
  for (const Index v : sources_) {
    reached_[v] = {0, none, v};
    starts.emplace_back(0.0, v);
  }
  const auto admits = [&](Index v) { return !network_.is_avoided[v]; };
  grow_paths(network_.edges, {std::move(starts), half_of(below)}, admits, reached_);
  list();
}

// The regions of vertices that left the cuts, and those that have new vertices of the cuts inside.
void CutRegions::regrow_changed() {
  ++round_;
  around_.clear();
  const auto add = [&](Index v) {
    around_.push_back(v);
    redone_[v] = round_;
  };
  for (Index v = 0; v < network_.mesh.vertex_count(); ++v) {
    const Index source = reached_[v].source;
    if (network_.holds(v) == (source == v) || redone_[v] == round_) continue;
    if (source == none) {
      add(v);
    } else {
      std::for_each(members_.begin() + first_[source], members_.begin() + first_[source + 1], add);
    }
  }
  for (const Index v : around_) reached_[v] = network_.holds(v) ? Reached{0, none, v} : Reached{};
  const auto admits = [&](Index v) { return !network_.is_avoided[v]; };
  grow_paths(network_.edges, {enter(below_, reached_), half_of(below_)}, admits, reached_);
}

// Reaches the vertices of `around_` from their neighbors elsewhere. Returns those that are reached.
PathStarts CutRegions::enter(double below, PerVertex<Reached>& reached) const {
  PathStarts starts;
  for (const Index v : around_) {
    for (const CutEdges::Edge& edge : network_.edges.from(v)) {
      if (redone_[edge.target] == round_) continue;
      const Reached& there = reached_[edge.target];
      if (there.source == none || !network_.holds(there.source)) continue;
      const double through = there.distance + edge.cost;
      if (!(through < half_of(below) && through < reached[v].distance)) continue;
      reached[v] = {through, network_.mesh.twin[edge.halfedge], there.source};
    }
    if (reached[v].source != none) starts.emplace_back(reached[v].distance, v);
  }
  return starts;
}

// The vertices of each region, and the edges between regions.
void CutRegions::list() {
  const HalfedgeMesh& mesh = network_.mesh;
  first_.assign(mesh.vertex_count() + 1, 0);
  for (const Reached& there : reached_) {
    if (there.source != none) ++first_[there.source + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  members_.resize(first_.back());
  Array<Index> cursor(first_.begin(), first_.end() - 1);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (reached_[v].source != none) members_[cursor[reached_[v].source]++] = v;
  }
  const auto separates = [&](Index v, const CutEdges::Edge& edge) {
    return reached_[v].source != reached_[edge.target].source && !was_cut_[edge.halfedge];
  };
  bridges_ = cheapest_of_pairs(find_bridges(mesh, network_.edges, reached_, separates), mesh.vertex_count());
}

// Distributes the regions of the interior vertices of a closed path over the neighboring ones, up to a cost.
void CutRegions::redo(const CutPath& closed, double below) {
  ++round_;
  around_.clear();
  for (std::size_t i = 1; i < closed.size(); ++i) {
    const Index base = network_.mesh.origin(closed[i]);
    for (Index m = first_[base]; m < first_[base + 1]; ++m) {
      around_.push_back(members_[m]);
      redone_[members_[m]] = round_;
      again_[members_[m]] = {};
    }
  }
  const auto admits = [&](Index v) { return redone_[v] == round_; };
  grow_paths(network_.edges, {enter(below, again_), half_of(below)}, admits, again_);
}

CutPath CutRegions::find(const CutPath& closed, const PerVertex<Index>& is_apart, Index mark, double below) {
  const HalfedgeMesh& mesh = network_.mesh;
  Index best = none;
  const auto joins = [&](Index a, Index b) {
    return a != none && b != none && (is_apart[a] == mark) != (is_apart[b] == mark) && network_.holds(a) &&
           network_.holds(b);
  };
  if (below > below_) grow(std::numeric_limits<double>::infinity());
  redo(closed, below);
  const auto is_redone = [&](Index source) { return redone_[source] == round_; };  // with its whole region
  for (const Bridge& bridge : bridges_) {
    if (!(bridge.cost < below)) break;
    if (!joins(bridge.low, bridge.high) || is_redone(bridge.low) || is_redone(bridge.high)) continue;
    below = bridge.cost;
    best = bridge.halfedge;
    break;
  }
  for (const Index v : around_) {
    const Reached& a = again_[v];
    if (!(a.distance < half_of(below))) continue;
    for (const CutEdges::Edge& edge : network_.edges.from(v)) {
      const Reached& b = at(edge.target);
      const double cost = a.distance + edge.cost + b.distance;
      if (!(cost < below) || !joins(a.source, b.source)) continue;
      below = cost;
      best = edge.halfedge;
    }
  }
  if (best == none) return {};
  // Cuts may have been opened across the path since the regions were built: a segment from one to the other suffices.
  const CutPath whole = path_through(best);
  const bool from = is_apart[mesh.origin(whole.front())] == mark;
  CutPath path;
  for (const Index h : whole) {
    const Index v = mesh.origin(h);
    const bool holds = network_.holds(v);
    if (holds && (is_apart[v] == mark) != from) break;
    if (holds) path.clear();
    path.push_back(h);
  }
  return path;
}

// The path from the vertex of the cuts at one end of an edge to that at the other.
CutPath CutRegions::path_through(Index bridge) const {
  const HalfedgeMesh& mesh = network_.mesh;
  CutPath path;
  for (Index h = at(mesh.origin(bridge)).by; h != none; h = at(mesh.origin(h)).by) path.push_back(h);
  std::reverse(path.begin(), path.end());
  path.push_back(bridge);
  for (Index h = at(mesh.target(bridge)).by; h != none; h = at(mesh.origin(h)).by) path.push_back(mesh.twin[h]);
  return path;
}

}  // namespace lsgp
