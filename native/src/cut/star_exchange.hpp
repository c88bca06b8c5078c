// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>

#include "base/array.hpp"
#include "cut/cut_network.hpp"
#include "cut/shortest_paths.hpp"

namespace lsgp {

// Closes the three paths of a junction, or two paths that meet, and joins the three subtrees of the cuts that are left
// at the vertex nearby where that costs least (key-vertex elimination and insertion of Steiner vertices, Uchoa and
// Werneck 2012).
class StarExchange {
 public:
  explicit StarExchange(CutNetwork& network);

  // Tries every star once, the most expensive nodes first, as far as the work for the network, proportional to the
  // surface, is not spent. Returns the relative reduction of cost.
  double try_all();

 private:
  // Two or three paths from a node, which divide the cuts in three when closed.
  struct Star {
    Array<CutPath> paths;
    std::array<Index, 3> ends;  // a vertex of each subtree
    double cost = 0;
  };

  Array<std::pair<double, Index>> find_nodes() const;
  Array<Star> stars_at(Index node) const;
  Star star_of(Index node, const Array<Index>& out) const;
  double exchange(const Star& star);
  bool mark_subtrees(const Star& star);
  void grow_around(const Star& star);
  void grow_from(std::size_t subtree, double below);
  double from_first(Index subtree) const;
  Index nearest_to_all(double below) const;
  CutPath joint_at(Index v) const;
  bool is_tree(const CutPath& joint) const;
  void clear();

  CutNetwork& network_;
  const HalfedgeMesh& mesh_;
  double work_left_;

  // Scratch, as it is here between stars.
  PerVertex<Index> subtree_of_;             // none
  Array<Index> marked_;                     // empty
  PerVertex<Reached> near_;                 // from the paths, none reached
  std::array<PerVertex<Reached>, 3> from_;  // from each subtree, none reached
  Array<Index> around_;                     // empty
};

}  // namespace lsgp
