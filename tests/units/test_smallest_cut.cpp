// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/smallest_cut.hpp"

#include <doctest/doctest.h>

#include "random_matrices.hpp"
#include "solvers/max_flow.hpp"

namespace {

using Units = lsgp::SmallestCut::Units;
using CapacityEdges = lsgp::Array<lsgp::SmallestCut::Edge>;

CapacityEdges random_edges(Random& random, int nodes, int count) {
  CapacityEdges out;
  for (int i = 0; i < count; ++i) {
    const int a = below(random, nodes), b = below(random, nodes);
    if (a != b) out.push_back({{a, b}, 1 + below(random, 20)});
  }
  return out;
}

// A grid with edges as long as those of a mesh.
CapacityEdges grid_edges(Random& random, int side) {
  CapacityEdges out;
  for (int node = 0; node < side * side; ++node) {
    if (node % side + 1 < side) out.push_back({{node, node + 1}, 5000 + below(random, 10000)});
    if (node + side < side * side) out.push_back({{node, node + side}, 5000 + below(random, 10000)});
  }
  return out;
}

// Grows both sets, the lists of which begin with one node each, and compares with flows.
void require_smallest_cuts(Random& random, int nodes, const CapacityEdges& edges) {
  lsgp::SmallestCut network(nodes, edges);
  lsgp::Array<lsgp::Array<int>> sets{{0}, {nodes - 1}};
  lsgp::Array<char> is_in_set(nodes, 0);
  is_in_set[0] = is_in_set[nodes - 1] = 1;
  network.add_to_first(0);
  network.add_to_second(nodes - 1);
  for (int round = 0; round < 4; ++round) {
    constexpr Units unlimited = 1 << 30;
    const int source = nodes, sink = nodes + 1;
    lsgp::FlowNetwork flow(nodes + 2);
    for (const auto& [ends, capacity] : edges) flow.add_arc(ends[0], ends[1], capacity, capacity);
    for (const int node : sets[0]) flow.add_arc(source, node, unlimited);
    for (const int node : sets[1]) flow.add_arc(node, sink, unlimited);
    const Units smallest = flow.maximize(source, sink);
    if (round == 1) {  // a search that ended early does not disturb the next one
      const Units enough = smallest / 2;
      const Units found = network.find_smallest(enough);
      CHECK(found >= enough);
      CHECK(found <= smallest);
    }
    CHECK(network.find_smallest() == smallest);
    lsgp::Array<char> reached = flow.reachable(source);
    reached.resize(nodes);
    CHECK(network.first_side() == reached);
    for (int i = 0; i < nodes / 8 + 1; ++i) {
      const int node = below(random, nodes), set = below(random, 2);
      if (is_in_set[node]) continue;
      is_in_set[node] = 1;
      sets[set].push_back(node);
      set == 0 ? network.add_to_first(node) : network.add_to_second(node);
    }
  }
}

}  // namespace

TEST_CASE("the smallest cuts between growing sets are those that flows find") {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const int nodes = 2 + below(random, 12);
    require_smallest_cuts(random, nodes, random_edges(random, nodes, below(random, 4 * nodes)));
  }
  for (const int side : {10, 40}) require_smallest_cuts(random, side * side, grid_edges(random, side));
}
