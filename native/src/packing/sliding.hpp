// SPDX-License-Identifier: GPL-3.0-or-later
// Islands slid along the axes until they touch others, exactly.
#pragma once

#include "base/array.hpp"
#include "packing/outline.hpp"

namespace lsgp {

enum class Axis { u, v };

// How far a point, moved against u, gets until it is `gap` from a segment; at most `limit`. From the start it is not
// closer; where it touches already, 0.
double travel_to_segment(Complex point, Complex a, Complex b, double gap, double limit);

// Outlines that lie still in the plane, found by their places.
class StillOutlines {
 public:
  // cell: side of the cells of the grid, about as large as an outline.
  StillOutlines(double width, double height, double cell);

  void add(Outline outline);

  // Whether an outline keeps a gap to all others.
  // looks: counts the pairs of segments that are looked at.
  bool has_room(const Outline& outline, double gap, double& looks) const;

  // How far an outline can be moved against an axis so that it keeps a gap to all others; at most `limit`.
  double free_way(const Outline& moving, Axis axis, double gap, double limit, double& looks) const;

 private:
  template <typename Visit>
  void for_each_cell(const Box& box, Visit visit) const;

  int column_count_, row_count_;
  double cell_;
  Array<Outline> outlines_;
  Array<Box> boxes_;
  Array<Array<Index>> in_cell_;
  mutable Array<Index> seen_;  // (outlines) the number of the last query that met it
  mutable Index query_ = 0;
};

}  // namespace lsgp
