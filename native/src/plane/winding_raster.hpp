// SPDX-License-Identifier: GPL-3.0-or-later
// Where a layout may overlap itself: winding numbers of its boundary on a raster.
#pragma once

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "plane/aabb_tree.hpp"
#include "plane/boundary_polygon.hpp"

namespace lsgp {

// The cells of a raster that a layout without flipped triangles may cover twice. The number of times a point is covered
// is the winding number of the boundary.
class WindingRaster {
 public:
  // frame: around the whole layout.
  WindingRaster(const BoundaryPolygon& boundary, const Box& frame, Index triangle_count);

  // Whether such a cell meets a box.
  bool meets(const Box& box) const;

 private:
  // The edges of the border that pass a cell.
  struct Passage {
    Index first = none, last = none;
    bool is_plain = true;  // one run of edges, all within a right angle of the first
  };

  void pass(const BoundaryPolygon& boundary, Index edge, Index row);
  void wind(Complex tail, Complex head, Index row);
  bool may_be_covered_twice(Index row, Index column) const;

  Index column_of(double x) const;
  Index row_of(double y) const;
  double bottom_of(Index row) const;

  Box frame_;
  double rounding_;  // of the coordinates
  Index columns_, rows_;
  double columns_per_unit_, rows_per_unit_;
  Array<Passage> passage_;  // (rows, columns)
  Array<Index> winding_;    // (rows + 1, columns + 1) at the corners of the cells
  Array<Index> doubtful_;   // (rows + 1, columns + 1) cells that may be covered twice, left of and below a corner
};

}  // namespace lsgp
