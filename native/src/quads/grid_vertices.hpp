// SPDX-License-Identifier: GPL-3.0-or-later
// The corners of the grid's cells on a surface: in triangles, on edges and at vertices, each once.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "quads/exact_grid.hpp"

namespace lsgp {

// The position of a point in a closed triangle: in the interior, or
struct Place {
  Index edge = none;    // on this halfedge, between its ends
  Index corner = none;  // at this corner
};

// None if the point is outside.
std::optional<Place> find_place(const ExactGrid& grid, Index triangle, GridPoint p);

struct GridVertex {
  Index triangle;  // its home: of a point on an edge the triangle of its lower halfedge, of one at a vertex that of the
                   // halfedge that leaves it
  GridPoint at;    // in the chart of that
  Place place;     // in it
};

class GridVertices {
 public:
  GridVertices(const HalfedgeMesh& mesh, const ExactGrid& grid);

  Index count() const { return static_cast<Index>(all_.size()); }
  const GridVertex& operator[](Index i) const { return all_[i]; }

  // The number of a corner of cells at a place of a triangle.
  Index find(Index triangle, GridPoint p, const Place& place) const;

 private:
  void add_points_of(Index triangle);
  bool is_home(const Place& place) const;

  const HalfedgeMesh& mesh_;
  const ExactGrid& grid_;
  Array<GridVertex> all_;       // by triangle, from the lowest row up, from left to right
  Array<Index> first_;          // (m + 1) of each triangle
  PerVertex<Index> at_vertex_;  // none where a vertex is no corner of cells
};

}  // namespace lsgp
