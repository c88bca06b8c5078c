// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/max_flow.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "random_matrices.hpp"

namespace {

using Units = lsgp::FlowNetwork::Units;

struct Arc {
  int from, to;
  Units capacity, capacity_back;
};

struct RandomNetwork {
  int nodes;
  std::vector<Arc> arcs;
  lsgp::FlowNetwork network;
};

RandomNetwork random_network(Random& random, int nodes, int arcs) {
  RandomNetwork out{nodes, {}, lsgp::FlowNetwork(nodes)};
  for (int i = 0; i < arcs; ++i) {
    const Arc arc{below(random, nodes), below(random, nodes), below(random, 10), below(random, 3)};
    if (arc.from == arc.to) continue;
    out.arcs.push_back(arc);
    out.network.add_arc(arc.from, arc.to, arc.capacity, arc.capacity_back);
  }
  return out;
}

// What leaves a set of nodes, given bit by bit.
Units capacity_out_of(const RandomNetwork& made, unsigned set) {
  Units out = 0;
  for (const Arc& arc : made.arcs) {
    const bool from = set >> arc.from & 1, to = set >> arc.to & 1;
    if (from && !to) out += arc.capacity;
    if (to && !from) out += arc.capacity_back;
  }
  return out;
}

}  // namespace

TEST_CASE("the maximum flow is what the smallest of all cuts lets pass") {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const int nodes = 2 + below(random, 8);
    RandomNetwork made = random_network(random, nodes, 3 * nodes);
    const int source = 0, sink = nodes - 1;
    Units smallest = std::numeric_limits<Units>::max();
    for (unsigned set = 0; set < 1u << nodes; ++set) {
      if ((set >> source & 1) && !(set >> sink & 1)) smallest = std::min(smallest, capacity_out_of(made, set));
    }
    CHECK(made.network.maximize(source, sink) == smallest);

    std::vector<Units> excess(static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < made.arcs.size(); ++i) {
      const Arc& arc = made.arcs[i];
      const Units flow = made.network.flow(static_cast<int>(i));
      CHECK(flow <= arc.capacity);
      CHECK(-flow <= arc.capacity_back);
      excess[static_cast<std::size_t>(arc.from)] -= flow;
      excess[static_cast<std::size_t>(arc.to)] += flow;
    }
    for (int node = 1; node + 1 < nodes; ++node) CHECK(excess[static_cast<std::size_t>(node)] == 0);
    CHECK(excess[static_cast<std::size_t>(sink)] == smallest);

    unsigned reached = 0;
    const auto reachable = made.network.reachable(source);
    for (int node = 0; node < nodes; ++node) reached |= static_cast<unsigned>(reachable[node] != 0) << node;
    CHECK(capacity_out_of(made, reached) == smallest);
  }
}

TEST_CASE("more is sent on top of what flows already") {
  lsgp::FlowNetwork network(3);
  network.add_arc(0, 1, 5);
  network.add_arc(1, 2, 3);
  CHECK(network.maximize(0, 2) == 3);
  network.add_arc(1, 2, 4);
  CHECK(network.maximize(0, 2) == 2);
  CHECK(network.maximize(0, 2) == 0);
}

TEST_CASE("nothing is sent on top of a maximum that was given as the first flow") {
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const int nodes = 2 + below(random, 8);
    RandomNetwork made = random_network(random, nodes, 3 * nodes);
    made.network.maximize(0, nodes - 1);
    lsgp::FlowNetwork again(nodes);
    for (std::size_t i = 0; i < made.arcs.size(); ++i) {
      const Arc& arc = made.arcs[i];
      again.send(again.add_arc(arc.from, arc.to, arc.capacity, arc.capacity_back),
                 made.network.flow(static_cast<int>(i)));
    }
    CHECK(again.maximize(0, nodes - 1) == 0);
    CHECK(again.reachable(0) == made.network.reachable(0));
  }
}
