// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest cut between two sets of nodes.
#pragma once

#include <cstdint>
#include <limits>

#include "base/array.hpp"

namespace lsgp {

// Edges with capacities between nodes 0, 1, ..., and two sets of nodes, which may grow. The push-relabel algorithm
// (Goldberg and Tarjan 1988) sends what it can from the second set to the first.
class SmallestCut {
 public:
  using Units = std::int64_t;

  struct Edge {
    int nodes[2];
    Units capacity;
  };

  SmallestCut(int node_count, const Array<Edge>& edges);

  // Puts a node that is in neither set into one of them.
  void add_to_first(int node);
  void add_to_second(int node);

  // The capacity of the smallest cut between the sets; where that is `enough` or more, perhaps less than it is, but at
  // least `enough`.
  Units find_smallest(Units enough = std::numeric_limits<Units>::max());

  // (nodes) Those on the first set's side of a smallest cut that was found, as few as there can be.
  Array<char> first_side() const;

 private:
  enum class Set : char { neither, first, second };

  // Every edge is an arc of both of its nodes. Those of a node follow each other.
  struct Arc {
    int to, reverse;
    Units residual;
  };

  // Nodes by their distance, in linked lists.
  class Levels {
   public:
    explicit Levels(int node_count) : first_(node_count, -1), next_(node_count, -1), previous_(node_count, -1) {}
    int first(int level) const { return first_[level]; }
    int next(int node) const { return next_[node]; }
    void insert(int node, int level);
    void remove(int node, int level);

   private:
    Array<int> first_, next_, previous_;  // -1 at either end of a list
  };

  void measure_distances();
  void discharge(int node);
  void push(int node, Arc& arc);
  void lift(int node);
  void close_gap(int distance);

  const int count_;
  Array<int> begin_;  // (nodes + 1) arcs
  Array<Arc> arcs_;
  Array<Set> set_;           // (nodes)
  Array<Units> excess_;      // (nodes in neither set) what arrived there, and was not sent on
  Units arrived_ = 0;        // in the first set
  Array<int> distance_;      // (nodes) arcs to the first set at least; the number of nodes where none lead there
  Array<int> current_;       // (nodes) the arc to try next
  Levels active_, resting_;  // nodes in neither set with an excess, and without one
  int highest_active_ = 0, highest_ = 0;
  double work_ = 0;  // since distances were measured, in arcs
};

}  // namespace lsgp
