// SPDX-License-Identifier: GPL-3.0-or-later
// Maximum flow and minimum cut.
#pragma once

#include <cstdint>
#include <vector>

namespace lsgp {

// A network of nodes 0, 1, ... whose arcs carry whole units.  Dinic's algorithm.
class FlowNetwork {
 public:
  using Units = std::int64_t;

  explicit FlowNetwork(int node_count);

  // An arc and the one back; returns its number.
  int add_arc(int from, int to, Units capacity, Units capacity_back = 0);

  // Sends as much as possible on top of what flows already; returns how much more.
  Units maximize(int source, int sink);

  Units flow(int arc) const;

  // (nodes) which of them `source` can still send to: its side of a minimum cut once the flow is maximal.
  std::vector<char> reachable(int source) const;
};

}  // namespace lsgp
