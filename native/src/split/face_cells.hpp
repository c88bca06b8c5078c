// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of faces, among which cuts are sought faster than among the faces.
#pragma once

#include <utility>

#include "base/array.hpp"
#include "split/face_graph.hpp"

namespace lsgp {

struct FaceCells {
  struct Edge {
    Index cells[2];
    FaceGraph::Units cost;
  };

  Array<double> area;
  Array<Edge> edges;  // one between any two neighbors, sorted

  Index count() const { return static_cast<Index>(area.size()); }

  // Sets the edges from those between single faces.
  void collect(Array<Edge>& all);

  // The edges of every cell: offsets into the list, and the list.
  std::pair<Array<Index>, Array<Index>> by_cell() const;

  // Merges pairs of neighbors, preferring those with the longest common boundary for their size; the first `held` cells
  // stay as they are. Returns the new cell of every cell.
  Array<Index> coarsen(Index held);
};

// A graph whose faces are cells of at least two faces each, and fewer than `most` of them where that is possible.
FaceGraph build_cell_graph(const FaceGraph& graph, Index most);

}  // namespace lsgp
