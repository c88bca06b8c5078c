// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/array.hpp"
#include "cut/cut_network.hpp"

namespace lsgp {

// Finds the cheapest path across the strip that remains when a cut is closed, even if the sides of the strip meet in
// other vertices, as around a handle.
class StripSearch {
 public:
  explicit StripSearch(const CutNetwork& network) : network_(network) {}

  // The successors of both ends of a path on the boundary of the opened surface, before the path was closed.
  struct Ends {
    Index after_head, after_tail;  // halfedges
  };
  Ends ends_of(const CutPath& path) const;

  // The cheapest path that opens the surface again after `path` was closed; empty if none is below a cost.
  CutPath find(const CutPath& path, const Ends& ends, double below);

 private:
  // How the search reached a vertex.
  struct Reached {
    double distance;
    Index by;      // the halfedge that leads there
    Index search;  // its number: entries of other searches are outdated
  };
  // The sides are marked by numbers unique to the strip; a side that is a single cone is given by that vertex.
  struct Side {
    Index mark, lone;
    Index length = 0;  // edges
  };

  template <typename Visit>
  Index follow_border(Index h, Visit visit) const;
  bool is_border(Index h) const { return network_.is_cut[h] || network_.mesh.twin[h] == none; }
  Side mark_side(Index first, Index lone);
  Array<Index> starts(const Side& side, Index first) const;
  bool arrives(const Side& side, Index h) const;
  CutPath cross(const Side& from, const Side& to, const Array<Index>& starts, double below);

  const CutNetwork& network_;
  // From the first search on:
  PerHalfedge<Index> mark_;  // the last one given
  PerVertex<Reached> reached_;
  Index marks_ = 0, searches_ = 0;
};

}  // namespace lsgp
