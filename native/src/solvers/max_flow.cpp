// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/max_flow.hpp"

#include <algorithm>
#include <limits>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double arc_visits = 10;  // multiplications that visiting an arc in a blocking flow costs

}  // namespace

FlowNetwork::FlowNetwork(int node_count) : first_(node_count, -1) {}

int FlowNetwork::add_arc(int from, int to, Units capacity, Units capacity_back) {
  const int arc = static_cast<int>(to_.size());
  to_.insert(to_.end(), {to, from});
  capacity_.insert(capacity_.end(), {capacity, capacity_back});
  residual_.insert(residual_.end(), {capacity, capacity_back});
  next_.insert(next_.end(), {first_[from], -1});
  first_[from] = arc;
  next_[arc + 1] = first_[to];
  first_[to] = arc + 1;
  return arc / 2;
}

void FlowNetwork::send(int arc, Units units) {
  residual_[2 * arc] -= units;
  residual_[2 * arc + 1] += units;
}

FlowNetwork::Units FlowNetwork::maximize(int source, int sink) {
  Units total = 0;
  // The distance grows with each blocking flow, so there are fewer of them than nodes.
  while (find_distances(source, sink)) {
    total += send_along_shortest(source, sink);
    checkpoint(arc_visits * static_cast<double>(to_.size()));
  }
  return total;
}

FlowNetwork::Units FlowNetwork::flow(int arc) const { return capacity_[2 * arc] - residual_[2 * arc]; }

Array<char> FlowNetwork::reachable(int source) const {
  Array<char> reached(first_.size(), 0);
  Array<int> front{source};
  reached[source] = 1;
  while (!front.empty()) {
    const int node = front.back();
    front.pop_back();
    for (int a = first_[node]; a >= 0; a = next_[a]) {
      if (residual_[a] == 0 || reached[to_[a]]) continue;
      reached[to_[a]] = 1;
      front.push_back(to_[a]);
    }
  }
  return reached;
}

// Levels are distances to the sink, so every level-decreasing path reaches it until blocked.
bool FlowNetwork::find_distances(int source, int sink) {
  distance_.assign(first_.size(), -1);
  distance_[sink] = 0;
  Array<int> queue{sink};
  for (std::size_t i = 0; i < queue.size() && distance_[source] < 0; ++i) {
    for (int a = first_[queue[i]]; a >= 0; a = next_[a]) {
      if (residual_[a ^ 1] == 0 || distance_[to_[a]] >= 0) continue;
      distance_[to_[a]] = distance_[queue[i]] + 1;
      queue.push_back(to_[a]);
    }
  }
  return distance_[source] >= 0;
}

// A blocking flow: walks toward the sink, sends the walk's capacity, continues from the saturated arc.
FlowNetwork::Units FlowNetwork::send_along_shortest(int source, int sink) {
  current_ = first_;
  Array<int> walk;  // arcs from the source
  Units total = 0;
  int node = source;
  for (;;) {
    if (node == sink) {
      Units units = std::numeric_limits<Units>::max();
      for (const int a : walk) units = std::min(units, residual_[a]);
      checkpoint(arc_visits * static_cast<double>(walk.size()));
      std::size_t blocked = walk.size();
      for (std::size_t i = walk.size(); i-- > 0;) {
        residual_[walk[i]] -= units;
        residual_[walk[i] ^ 1] += units;
        if (residual_[walk[i]] == 0) blocked = i;
      }
      total += units;
      node = to_[walk[blocked] ^ 1];
      walk.resize(blocked);
      continue;
    }
    int& a = current_[node];
    while (a >= 0 && (residual_[a] == 0 || distance_[to_[a]] != distance_[node] - 1)) a = next_[a];
    if (a >= 0) {
      walk.push_back(a);
      node = to_[a];
    } else if (node == source) {
      return total;
    } else {
      distance_[node] = -1;
      node = to_[walk.back() ^ 1];
      walk.pop_back();
    }
  }
}

}  // namespace lsgp
