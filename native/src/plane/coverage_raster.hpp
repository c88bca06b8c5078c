// SPDX-License-Identifier: GPL-3.0-or-later
// How often pieces of a layout cover the points of a raster, from their boundary polygons.
#pragma once

#include <complex>

#include "base/array.hpp"
#include "plane/aabb_tree.hpp"

namespace lsgp {

// Directed edges of closed boundary polygons, with the interior on the left.
class CoverageRaster {
 public:
  // cell: side of a cell; larger if the frame would need too many.
  CoverageRaster(const Box& frame, double cell);

  const Box& frame() const { return frame_; }
  void add(Complex tail, Complex head);
  // Call once all edges are added.
  void sum_up();

  // The area covered by pairs of pieces, summed over the pairs.
  double doubly_covered() const;

  // The contribution of an edge to the area that its polygon shares with the pieces added, summed over the pairs.
  double shared(Complex tail, Complex head) const;

 private:
  double row_of(double y) const { return (y - frame_.bottom) / cell_ - 0.5; }  // rows run through cell centers

  // Calls visit(row, cells to the left of where the edge crosses it, 1 upwards or -1 downwards).
  template <typename Visit>
  void for_each_crossing(Complex tail, Complex head, Visit visit) const;

  Box frame_;
  double cell_;
  Index columns_, rows_;
  // (rows, columns + 1) covers of the cells left of each corner, summed along the row; until sum_up, second differences
  // of these sums.
  Array<Index> cells_left_;
};

}  // namespace lsgp
