// SPDX-License-Identifier: GPL-3.0-or-later
// Maximum flow and minimum cut.
#pragma once

#include <cstdint>

#include "base/array.hpp"

namespace lsgp {

// A network of nodes 0, 1, ... whose arcs carry whole units. Dinic's algorithm.
class FlowNetwork {
 public:
  using Units = std::int64_t;

  explicit FlowNetwork(int node_count);

  // Adds an arc and its reverse; returns the number of the arc.
  int add_arc(int from, int to, Units capacity, Units capacity_back = 0);

  // Adds to the flow of an arc without regard to its capacity and to the other arcs of its nodes: for a first flow that
  // is close to the maximum.
  void send(int arc, Units units);

  // Augments the flow to a maximum; returns the increase.
  Units maximize(int source, int sink);

  Units flow(int arc) const;  // net, from its first node to its second

  // (nodes) those reachable from `source` in the residual network: its side of a minimum cut once the flow is maximal.
  Array<char> reachable(int source) const;

 private:
  bool find_distances(int source, int sink);
  Units send_along_shortest(int source, int sink);

  // Arc a and its reverse, a ^ 1, are adjacent. The arcs of a node are a linked list.
  Array<int> first_, next_, to_;      // (nodes), (arcs), (arcs) -1 at the end of a list
  Array<Units> residual_, capacity_;  // (arcs) the remaining and the initial capacity
  Array<int> distance_, current_;     // (nodes) arcs to the sink, -1 without a path; the arc to try next
};

}  // namespace lsgp
