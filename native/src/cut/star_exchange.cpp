// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/star_exchange.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "base/union_find.hpp"
#include "cut/shortest_paths.hpp"

namespace lsgp {

namespace {

constexpr double reach = 0.34;           // of the cost of the paths that are closed: how far away they are joined
constexpr double work_a_vertex = 0.5;    // vertices around stars for each of the surface, in all
constexpr double least_work = 2500;      // of them, anyway
constexpr double least_gain = 1e-9;      // of the cost: rounding is no gain
constexpr double operations_a_cut = 20;  // of finding the subtrees

}  // namespace

StarExchange::StarExchange(CutNetwork& network)
    : network_(network),
      mesh_(network.mesh),
      work_left_(std::max(least_work, work_a_vertex * static_cast<double>(network.mesh.vertex_count()))),
      subtree_of_(network.mesh.vertex_count(), none),
      near_(network.mesh.vertex_count()) {
  for (PerVertex<Reached>& from : from_) from.resize(mesh_.vertex_count());
}

// With the cost of their paths, negative: the most expensive first.
Array<std::pair<double, Index>> StarExchange::find_nodes() const {
  Array<std::pair<double, Index>> out;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (network_.degree[v] < 2 || !network_.is_node(v) || network_.is_on_border(v)) continue;
    double cost = 0;
    mesh_.for_each_outgoing(v, [&](Index h) {
      if (network_.is_cut[h]) cost += network_.cost(network_.trace(h));
    });
    if (cost > 0) out.emplace_back(-cost, v);
  }
  std::sort(out.begin(), out.end());
  return out;
}

StarExchange::Star StarExchange::star_of(Index node, const Array<Index>& out) const {
  Star star;
  star.ends.fill(node);
  for (std::size_t i = 0; i < out.size(); ++i) {
    CutPath path = network_.trace(out[i]);
    const bool leaves = mesh_.origin(path.front()) == node;
    star.ends[i] = leaves ? mesh_.target(path.back()) : mesh_.origin(path.front());
    star.cost += network_.cost(path);
    star.paths.push_back(std::move(path));
  }
  return star;
}

// A junction that need not stay goes with all its paths.
Array<StarExchange::Star> StarExchange::stars_at(Index node) const {
  Array<Index> out;
  mesh_.for_each_outgoing(node, [&](Index h) {
    if (network_.is_cut[h]) out.push_back(h);
  });
  if (out.size() == 3 && !network_.is_cone[node]) return {star_of(node, out)};
  Array<Star> stars;
  if (out.size() < 2 || !network_.is_node(node)) return stars;
  for (std::size_t i = 0; i + (out.size() == 2) < out.size(); ++i) {
    stars.push_back(star_of(node, {out[i], out[(i + 1) % out.size()]}));
  }
  return stars;
}

// Returns whether the ends of a closed star are in different subtrees.
bool StarExchange::mark_subtrees(const Star& star) {
  Index subtree = 0;
  for (const Index end : star.ends) {
    if (subtree_of_[end] != none) return false;
    std::size_t next_marked = marked_.size();
    const auto visit = [&](Index v) {
      if (subtree_of_[v] != none) return;
      subtree_of_[v] = subtree;
      marked_.push_back(v);
    };
    for (visit(end); next_marked < marked_.size(); ++next_marked) {
      network_.for_each_joined(marked_[next_marked], visit);
    }
    ++subtree;
  }
  return true;
}

// The surroundings of a star that was closed.
void StarExchange::grow_around(const Star& star) {
  PathStarts starts;
  const auto start = [&](Index v) {
    if (near_[v].source != none) return;
    near_[v] = {0, none, v};
    around_.push_back(v);
    starts.emplace_back(0.0, v);
  };
  for (const CutPath& path : star.paths) {
    for (const Index h : path) start(mesh_.origin(h));
    start(mesh_.target(path.back()));
  }
  const auto admits = [&](Index v) {
    const bool is_known = subtree_of_[v] != none || !network_.holds(v);  // not on other cuts
    if (network_.is_avoided[v] || !is_known) return false;
    if (near_[v].source == none) around_.push_back(v);
    return true;
  };
  grow_paths(network_.edges, {std::move(starts), reach * star.cost}, admits, near_);
}

void StarExchange::grow_from(std::size_t subtree, double below) {
  PerVertex<Reached>& from = from_[subtree];
  PathStarts starts;
  for (const Index v : around_) {
    if (subtree_of_[v] != static_cast<Index>(subtree)) continue;
    from[v] = {0, none, v};
    starts.emplace_back(0.0, v);
  }
  grow_paths(network_.edges, {std::move(starts), below}, [&](Index v) { return near_[v].source != none; }, from);
}

// The distance from the first subtree to another.
double StarExchange::from_first(Index subtree) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Index v : around_) {
    if (subtree_of_[v] == subtree) least = std::min(least, from_[0][v].distance);
  }
  return least;
}

// `none` if nowhere the paths from all subtrees cost less.
Index StarExchange::nearest_to_all(double below) const {
  Index best = none;
  for (const Index v : around_) {
    const double sum = from_[0][v].distance + from_[1][v].distance + from_[2][v].distance;
    if (sum < below || (sum == below && best != none && v < best)) {
      below = sum;
      best = v;
    }
  }
  return best;
}

CutPath StarExchange::joint_at(Index v) const {
  CutPath out;
  for (const PerVertex<Reached>& from : from_) {
    for (Index h = from[v].by; h != none; h = from[mesh_.origin(h)].by) out.push_back(std::min(h, mesh_.twin[h]));
  }
  sort_unique(out);
  return out;
}

// Whether edges join all subtrees and close no curve.
bool StarExchange::is_tree(const CutPath& joint) const {
  std::map<Index, Index> number;  // of vertices off the subtrees
  const auto node = [&](Index v) {
    if (subtree_of_[v] != none) return subtree_of_[v];
    return 3 + number.try_emplace(v, static_cast<Index>(number.size())).first->second;
  };
  UnionFind joined(3 + 2 * static_cast<Index>(joint.size()));
  bool is_open = true;
  for (const Index h : joint) is_open = joined.unite(node(mesh_.origin(h)), node(mesh_.target(h))) && is_open;
  return is_open && joined.find(1) == 0 && joined.find(2) == 0;
}

void StarExchange::clear() {
  for (const Index v : marked_) subtree_of_[v] = none;
  for (const Index v : around_) near_[v] = from_[0][v] = from_[1][v] = from_[2][v] = {};
  work_left_ -= static_cast<double>(around_.size());
  checkpoint(operations_a_cut * static_cast<double>(marked_.size()));
  marked_.clear();
  around_.clear();
}

double StarExchange::exchange(const Star& star) {
  const auto is_closed = [&](const CutPath& path) { return mesh_.origin(path.front()) == mesh_.target(path.back()); };
  if (std::any_of(star.paths.begin(), star.paths.end(), is_closed)) return 0;
  for (const CutPath& path : star.paths) network_.close(path);
  CutPath joint;
  if (mark_subtrees(star)) {
    const double below = (1 - least_gain) * star.cost;
    grow_around(star);
    grow_from(0, below);
    // The other two subtrees are at least so far from a vertex together as from each other.
    const double to_first = from_first(1), to_second = from_first(2);
    grow_from(1, below - to_second);
    grow_from(2, below - to_first);
    const Index at = nearest_to_all(below);
    if (at != none) joint = joint_at(at);
    if (!joint.empty() && !is_tree(joint)) joint.clear();
  }
  if (joint.empty()) {
    for (const CutPath& path : star.paths) network_.open(path);
  } else {
    network_.open(joint);
  }
  clear();
  return joint.empty() ? 0 : star.cost - network_.cost(joint);
}

double StarExchange::try_all() {
  const double before = network_.total_cost();
  double gained = 0;
  for (const auto& [_, node] : find_nodes()) {
    for (std::size_t i = 0; work_left_ > 0; ++i) {
      const Array<Star> stars = stars_at(node);
      if (i >= stars.size()) break;
      gained += exchange(stars[i]);
    }
  }
  return before > 0 ? gained / before : 0;
}

}  // namespace lsgp
