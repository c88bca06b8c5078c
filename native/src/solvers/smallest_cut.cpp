// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/smallest_cut.hpp"

#include <algorithm>
#include <numeric>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double operations_an_arc = 10;  // multiplications that looking at one costs
// Distances are measured again after this many visits of arcs for each node, counting some for each lifted one.
constexpr double most_visits = 6, visits_a_lift = 12;

}  // namespace

void SmallestCut::Levels::insert(int node, int level) {
  const int next = first_[level];
  next_[node] = next;
  previous_[node] = -1;
  if (next >= 0) previous_[next] = node;
  first_[level] = node;
}

void SmallestCut::Levels::remove(int node, int level) {
  const int next = next_[node], previous = previous_[node];
  (previous >= 0 ? next_[previous] : first_[level]) = next;
  if (next >= 0) previous_[next] = previous;
}

SmallestCut::SmallestCut(int node_count, const Array<Edge>& edges)
    : count_(node_count),
      begin_(node_count + 1, 0),
      arcs_(2 * edges.size()),
      set_(node_count, Set::neither),
      excess_(node_count, 0),
      distance_(node_count),
      active_(node_count),
      resting_(node_count) {
  for (const Edge& edge : edges) {
    for (const int node : edge.nodes) ++begin_[node + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  current_.assign(begin_.begin(), begin_.end() - 1);
  for (const auto& [nodes, capacity] : edges) {
    const int a = current_[nodes[0]]++, b = current_[nodes[1]]++;
    arcs_[a] = {nodes[1], b, capacity};
    arcs_[b] = {nodes[0], a, capacity};
  }
}

void SmallestCut::add_to_first(int node) {
  set_[node] = Set::first;
  arrived_ += excess_[node];
  excess_[node] = 0;
}

void SmallestCut::add_to_second(int node) {
  set_[node] = Set::second;
  excess_[node] = 0;
  for (int a = begin_[node]; a < begin_[node + 1]; ++a) {
    Arc& arc = arcs_[a];
    if (set_[arc.to] == Set::first) arrived_ += arc.residual;
    if (set_[arc.to] == Set::neither) excess_[arc.to] += arc.residual;
    arcs_[arc.reverse].residual += arc.residual;
    arc.residual = 0;
  }
}

SmallestCut::Units SmallestCut::find_smallest(Units enough) {
  measure_distances();
  while (highest_active_ > 0 && arrived_ < enough) {
    const int node = active_.first(highest_active_);
    if (node < 0) {
      --highest_active_;
      continue;
    }
    discharge(node);
    if (work_ > most_visits * count_ + static_cast<double>(arcs_.size())) measure_distances();
  }
  return arrived_;
}

Array<char> SmallestCut::first_side() const {
  Array<char> reached(count_, 0);
  Array<int> queue;
  for (int node = 0; node < count_; ++node) {
    if (set_[node] != Set::first) continue;
    reached[node] = 1;
    queue.push_back(node);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (int a = begin_[queue[i]]; a < begin_[queue[i] + 1]; ++a) {
      const Arc& arc = arcs_[a];
      if (reached[arc.to] || arcs_[arc.reverse].residual == 0) continue;
      reached[arc.to] = 1;
      queue.push_back(arc.to);
    }
  }
  return reached;
}

void SmallestCut::measure_distances() {
  distance_.assign(count_, count_);
  current_.assign(begin_.begin(), begin_.end() - 1);
  active_ = resting_ = Levels(count_);
  highest_active_ = highest_ = 0;
  Array<int> queue;
  for (int node = 0; node < count_; ++node) {
    if (set_[node] != Set::first) continue;
    distance_[node] = 0;
    queue.push_back(node);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const int node = queue[i], distance = distance_[node];
    if (set_[node] == Set::neither) {
      highest_ = distance;
      (excess_[node] > 0 ? active_ : resting_).insert(node, distance);
      if (excess_[node] > 0) highest_active_ = distance;
    }
    for (int a = begin_[node]; a < begin_[node + 1]; ++a) {
      const Arc& arc = arcs_[a];
      if (distance_[arc.to] < count_ || set_[arc.to] == Set::second || arcs_[arc.reverse].residual == 0) continue;
      distance_[arc.to] = distance + 1;
      queue.push_back(arc.to);
    }
  }
  work_ = 0;
  checkpoint(operations_an_arc * static_cast<double>(arcs_.size()));
}

// Sends the excess of a node on, and lifts the node where that is needed.
void SmallestCut::discharge(int node) {
  active_.remove(node, distance_[node]);
  while (excess_[node] > 0 && distance_[node] < count_) {
    int& a = current_[node];
    for (; a < begin_[node + 1]; ++a) {
      Arc& arc = arcs_[a];
      if (arc.residual == 0 || distance_[arc.to] != distance_[node] - 1) continue;
      push(node, arc);
      if (excess_[node] == 0) break;  // more may go along this arc
    }
    if (excess_[node] > 0) lift(node);
  }
  if (excess_[node] == 0) resting_.insert(node, distance_[node]);
}

void SmallestCut::push(int node, Arc& arc) {
  const Units units = std::min(excess_[node], arc.residual);
  arc.residual -= units;
  arcs_[arc.reverse].residual += units;
  excess_[node] -= units;
  if (set_[arc.to] == Set::first) {
    arrived_ += units;
    return;
  }
  if (excess_[arc.to] == 0) {
    resting_.remove(arc.to, distance_[arc.to]);
    active_.insert(arc.to, distance_[arc.to]);
  }
  excess_[arc.to] += units;
}

// Of a node in neither list, from which no arc leads nearer.
void SmallestCut::lift(int node) {
  const int before = distance_[node];
  if (active_.first(before) < 0 && resting_.first(before) < 0) {
    close_gap(before);
    distance_[node] = count_;
    return;
  }
  int& distance = distance_[node];
  distance = count_;
  for (int a = begin_[node]; a < begin_[node + 1]; ++a) {
    const Arc& arc = arcs_[a];
    if (arc.residual == 0 || set_[arc.to] == Set::second || distance_[arc.to] + 1 >= distance) continue;
    distance = distance_[arc.to] + 1;
    current_[node] = a;
  }
  work_ += visits_a_lift + begin_[node + 1] - begin_[node];
  if (distance == count_) return;
  highest_ = std::max(highest_, distance);
  highest_active_ = std::max(highest_active_, distance);
}

// Where no node has some distance, none leads to the first set from beyond.
void SmallestCut::close_gap(int distance) {
  for (int level = distance + 1; level <= highest_; ++level) {
    for (Levels* nodes : {&active_, &resting_}) {
      while (nodes->first(level) >= 0) {
        const int node = nodes->first(level);
        nodes->remove(node, level);
        distance_[node] = count_;
      }
    }
  }
  highest_ = distance - 1;
  highest_active_ = std::min(highest_active_, highest_);
}

}  // namespace lsgp
