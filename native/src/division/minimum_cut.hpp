// SPDX-License-Identifier: GPL-3.0-or-later
// The minimum cut that separates two sets of faces.
#pragma once

#include <limits>

#include "base/array.hpp"
#include "division/face_graph.hpp"

namespace lsgp {

// Divides the faces of a scope in two.
struct MinimumCut {
  Array<char> is_first;  // (faces of the scope)
  double cost = std::numeric_limits<double>::infinity();
};

// The shortest cut hugs the faces to be separated and leaves slivers.
enum class CutCost {
  shortest,
  no_slivers,      // short relative to the width of the smaller of the two resulting parts
  no_small_parts,  // short relative to its area
};

// Searches for cuts of one layout may have so many faces in all, relative to those of the layout. A search takes about
// a microsecond for each; ordinary layouts take some 5, and those of forty handles with a cut at each 20.
constexpr double most_searches = 32;

class MinimumCutter {
 public:
  MinimumCutter(const FaceGraph& graph, CutCost rule) : graph_(graph), rule_(rule), place_(graph.face_count(), none) {}

  // first, second: faces of the scope to be separated.  The cost is infinite if no cut is known to cost less than
  // `cost_to_beat`.
  MinimumCut cut(const Array<Index>& scope, const Array<Index>& first, const Array<Index>& second,
                 double cost_to_beat = std::numeric_limits<double>::infinity());

  // Of a cut of this length.
  double cost(FaceGraph::Units length, double smaller_area) const;

 private:
  struct Cells;
  struct CellCut {
    Array<char> is_first, is_held;  // (cells) held ones may not change sides
    double cost = std::numeric_limits<double>::infinity();
  };
  Cells cells_of(const Array<Index>& scope, const Array<Index>& cell_of_place, Index count) const;
  FaceGraph::Units useless_length(double least_cost) const;
  Array<CellCut> cut_cells(const Cells& cells, double slack, double best) const;
  MinimumCut refine(const Array<Index>& scope, const Array<char>& is_held, const MinimumCut& coarse, int rings,
                    double cost_to_beat) const;
  bool leaves_two(const Array<Index>& scope, const Array<char>& is_first) const;
  double enough() const;

  const FaceGraph& graph_;
  const CutCost rule_;
  PerFace<Index> place_;  // in the scope, none elsewhere
};

}  // namespace lsgp
