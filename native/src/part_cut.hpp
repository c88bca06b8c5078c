// SPDX-License-Identifier: GPL-3.0-or-later
// The cut that parts two sets of faces from each other.
#pragma once

#include <limits>
#include <vector>

#include "face_graph.hpp"

namespace lsgp {

// Divides the faces of a scope in two.
struct PartCut {
  std::vector<char> is_first;  // (faces of the scope)
  double cost = std::numeric_limits<double>::infinity();
};

// Next to what is to be parted cuts are shortest, but leave scraps.
enum class CutTaste {
  shortest,
  no_scraps,       // short for the width of the smaller of the two parts that are left
  no_small_parts,  // short for its area
};

class PartCutter {
 public:
  PartCutter(const FaceGraph& graph, CutTaste taste) : graph_(graph), taste_(taste), place_(graph.face_count(), none) {}

  // first, second: faces of the scope that are to be parted.  The cost is infinite where no cut can do that.
  PartCut cut(const std::vector<Index>& scope, const std::vector<Index>& first, const std::vector<Index>& second);

  // Of a cut so long.
  double cost(FaceGraph::Units length, double smaller_area) const;

 private:
  struct Cells;
  struct CellCut {
    std::vector<char> is_first, is_held;  // (cells) held ones may not change sides
    double cost = std::numeric_limits<double>::infinity();
  };
  Cells cells_of(const std::vector<Index>& scope, const std::vector<Index>& cell_of_place, Index count) const;
  std::vector<CellCut> cut_cells(const Cells& cells, double slack) const;
  PartCut refine(const std::vector<Index>& scope, const std::vector<char>& is_held, const PartCut& coarse, int rings,
                 double cost_to_beat) const;
  bool leaves_two(const std::vector<Index>& scope, const std::vector<char>& is_first) const;
  double enough() const;

  const FaceGraph& graph_;
  const CutTaste taste_;
  std::vector<Index> place_;  // (faces) in the scope, none elsewhere
};

}  // namespace lsgp
