// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/strip_search.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/checkpoint.hpp"
#include "base/least_first.hpp"

namespace lsgp {

// The next boundary halfedge of the opened surface, from the target of h; visits the outgoing halfedges in between.
template <typename Visit>
Index StripSearch::follow_border(Index h, Visit visit) const {
  Index g = next(h);
  while (!is_border(g)) {
    visit(g);
    g = next(network_.mesh.twin[g]);
  }
  return g;
}

StripSearch::Ends StripSearch::ends_of(const CutPath& path) const {
  const auto pass_by = [](Index) {};
  return {follow_border(path.back(), pass_by), follow_border(network_.mesh.twin[path.front()], pass_by)};
}

// The side whose boundary starts with `first`, unless it is a single cone.
StripSearch::Side StripSearch::mark_side(Index first, Index lone) {
  Side side{++marks_, lone};
  if (lone != none) return side;
  Index h = first;
  do {
    mark_[h] = side.mark;
    ++side.length;
    h = follow_border(h, [](Index) {});
  } while (h != first);
  return side;
}

// Halfedges that lead away from a side.
Array<Index> StripSearch::starts(const Side& side, Index first) const {
  Array<Index> out;
  if (side.lone != none) {
    network_.mesh.for_each_outgoing(side.lone, [&](Index h) { out.push_back(h); });
    return out;
  }
  Index h = first;
  do {
    h = follow_border(h, [&](Index g) { out.push_back(g); });
  } while (h != first);
  return out;
}

bool StripSearch::arrives(const Side& side, Index h) const {
  const Index v = network_.mesh.target(h);
  if (side.lone != none) return v == side.lone;
  const bool on_border = network_.degree[v] > 0 || network_.is_on_border(v);
  return on_border && mark_[follow_border(h, [](Index) {})] == side.mark;
}

CutPath StripSearch::find(const CutPath& path, const Ends& ends, double below) {
  const HalfedgeMesh& mesh = network_.mesh;
  if (mark_.empty()) {  // few surfaces have strips
    mark_.assign(mesh.halfedge_count(), 0);
    reached_.assign(mesh.vertex_count(), {0, none, 0});
  }
  const bool lone_head = ends.after_head == mesh.twin[path.back()], lone_tail = ends.after_tail == path.front();
  const Side head = mark_side(ends.after_head, lone_head ? mesh.target(path.back()) : none);
  // The path may have separated two pieces, which are now connected.
  if (!lone_tail && mark_[ends.after_tail] == head.mark) return {};
  const Side tail = mark_side(ends.after_tail, lone_tail ? mesh.origin(path.front()) : none);
  if (head.length <= tail.length) return cross(head, tail, starts(head, ends.after_head), below);
  return cross(tail, head, starts(tail, ends.after_tail), below);
}

CutPath StripSearch::cross(const Side& from, const Side& to, const Array<Index>& starts, double below) {
  constexpr double operations_a_vertex = 100;
  const HalfedgeMesh& mesh = network_.mesh;
  using Entry = std::pair<double, Index>;
  LeastFirst<Entry> queue;
  const Index search = ++searches_;
  const auto is_inside = [&](Index v) {
    return network_.degree[v] == 0 && !network_.is_on_border(v) && v != from.lone;
  };
  Index last = none;
  const auto relax = [&](const CutEdges::Edge& edge, double before) {
    const Index v = edge.target;
    const double through = before + edge.cost;
    if (!(through < below) || network_.is_avoided[v]) return;
    if (arrives(to, edge.halfedge)) {
      below = through;
      last = edge.halfedge;
      return;
    }
    Reached& there = reached_[v];
    if (!is_inside(v) || (there.search == search && there.distance <= through)) return;
    there = {through, edge.halfedge, search};
    queue.emplace(through, v);
  };
  for (const Index h : starts) {
    if (may_cut(mesh, h)) relax({cut_cost(network_, h), h, mesh.target(h)}, 0);
  }
  while (!queue.empty() && queue.top().first < below) {
    checkpoint(operations_a_vertex);
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > reached_[v].distance) continue;
    for (const CutEdges::Edge& edge : network_.edges.from(v)) relax(edge, distance);
  }
  CutPath path;
  for (Index h = last; h != none;) {
    path.push_back(h);
    const Index v = mesh.origin(h);
    h = is_inside(v) ? reached_[v].by : none;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace lsgp
