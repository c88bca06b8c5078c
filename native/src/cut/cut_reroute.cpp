// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_reroute.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

namespace {

[[noreturn]] void refuse(const char* message) { throw Error(Code::cut_not_movable, message); }

}  // namespace

CutReroute::CutReroute(const MetricMesh& surface, MovedCut cut)
    : mesh_(surface.mesh),
      edges_(surface),
      cut_(std::move(cut)),
      tail_(surface.mesh.origin(cut_.path.front())),
      head_(surface.mesh.target(cut_.path.back())),
      is_closed_to_(cut_.is_node) {
  const HalfedgeMesh& mesh = surface.mesh;
  for (Index v = 0; v < mesh.vertex_count(); ++v) is_closed_to_[v] |= mesh.loop_of_vertex[v] != none;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (cut_.is_other[h]) is_closed_to_[mesh.origin(h)] = 1;
  }
  is_closed_to_[tail_] = is_closed_to_[head_] = 1;
  from_tail_ = grow_from(tail_);
  from_head_ = grow_from(head_);
}

PerVertex<Reached> CutReroute::grow_from(Index end) const {
  PerVertex<Reached> reached(mesh_.vertex_count());
  reached[end] = {0, none, end};
  grow_paths(edges_, {{{0, end}}}, [&](Index v) { return !is_closed_to_[v]; }, reached);
  return reached;
}

// The halfedges from v back to where it was reached from.
Array<Index> CutReroute::way_back(const PerVertex<Reached>& reached, Index v) const {
  Array<Index> way;
  for (Index h = reached[v].by; h != none; h = reached[mesh_.origin(h)].by) way.push_back(mesh_.twin[h]);
  return way;
}

// The cheapest way from v to the last end that avoids the vertices of a way from v to the first end.
Array<Index> CutReroute::way_around(Index v, const Array<Index>& avoided) const {
  PerVertex<char> is_closed = is_closed_to_;
  for (const Index h : avoided) is_closed[mesh_.target(h)] = 1;
  is_closed[head_] = 0;
  PerVertex<Reached> reached(mesh_.vertex_count());
  reached[v] = {0, none, v};
  grow_paths(edges_, {{{0, v}}}, [&](Index w) { return !is_closed[w]; }, reached);
  Array<Index> way = way_back(reached, head_);
  std::reverse(way.begin(), way.end());
  for (Index& h : way) h = mesh_.twin[h];
  return way;
}

Array<Index> CutReroute::way_through(Index v) const {
  if (is_closed_to_[v]) refuse("A cone, a boundary or another cut is there. Move the cut elsewhere.");
  const Array<Index> back = way_back(from_tail_, v);
  Array<Index> onward = way_back(from_head_, v);
  if (back.empty() || onward.empty()) refuse("Other cuts and boundaries are in the way. Move the cut elsewhere.");
  PerVertex<char> is_taken(mesh_.vertex_count(), 0);
  for (const Index h : back) is_taken[mesh_.target(h)] = 1;
  if (std::any_of(onward.begin(), onward.end(), [&](Index h) { return is_taken[mesh_.target(h)]; })) {
    onward = way_around(v, back);
    if (onward.empty() || onward.back() == mesh_.twin[back.back()] || onward.front() == back.front()) {
      refuse("There is no room for the cut to go there and back. Move it elsewhere.");
    }
  }
  Array<Index> way;
  for (auto h = back.rbegin(); h != back.rend(); ++h) way.push_back(mesh_.twin[*h]);
  way.insert(way.end(), onward.begin(), onward.end());
  return way;
}

// By how much the power increases from each halfedge's triangle to the one beyond.
PerHalfedge<int> CutReroute::jumps(const Array<Index>& way) const {
  PerHalfedge<int> jump(mesh_.halfedge_count(), 0);
  const auto add = [&](const Array<Index>& halfedges, int amount) {
    for (const Index h : halfedges) {
      jump[h] += amount;
      jump[mesh_.twin[h]] -= amount;
    }
  };
  // Where the cut was, both sides meet: the left one moves once more. Where it is, they separate in the same way.
  add(cut_.path, -1);
  add(way, 1);
  return jump;
}

PerTriangle<int> CutReroute::powers(const Array<Index>& way) const {
  const PerHalfedge<int> jump = jumps(way);
  PerTriangle<int> power(mesh_.triangle_count(), 0);
  PerTriangle<char> is_reached(mesh_.triangle_count(), 0);
  Array<Index> queue;
  queue.reserve(mesh_.triangle_count());
  queue.push_back(cut_.path.front() / 3);
  is_reached[queue.front()] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Index f = queue[i];
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index beyond = mesh_.twin[h];
      if (beyond == none || cut_.is_other[h]) continue;
      const Index g = beyond / 3;
      const int wanted = power[f] + jump[h];
      if (!is_reached[g]) {
        is_reached[g] = 1;
        power[g] = wanted;
        queue.push_back(g);
      } else if (power[g] != wanted) {
        refuse("A handle, a cone or another cut lies between. Move the cut elsewhere.");
      }
    }
  }
  const int still = rest(queue, power);
  for (const Index f : queue) power[f] -= still;
  return power;
}

// The power of what has to stay: of the triangles beside other cuts, or, without any, of most triangles.
int CutReroute::rest(const Array<Index>& moved, const PerTriangle<int>& power) const {
  int least = power[moved.front()], largest = least;
  for (const Index f : moved) {
    least = std::min(least, power[f]);
    largest = std::max(largest, power[f]);
  }
  Array<Index> counts(largest - least + 1, 0), beside(largest - least + 1, 0);
  for (const Index f : moved) {
    ++counts[power[f] - least];
    for (Index h = 3 * f; h < 3 * f + 3; ++h) beside[power[f] - least] += cut_.is_other[h] != 0;
  }
  const auto most = std::max_element(beside.begin(), beside.end());
  if (*most == 0) {
    return least + static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }
  if (std::count(beside.begin(), beside.end(), 0) + 1 < ssize(beside)) {
    refuse("A cone or another cut lies between. Move the cut elsewhere.");
  }
  return least + static_cast<int>(most - beside.begin());
}

}  // namespace lsgp
