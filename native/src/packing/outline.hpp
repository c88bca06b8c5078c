// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of islands: the closed polygons around what their triangles cover.
#pragma once

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "plane/aabb_tree.hpp"

namespace lsgp {

// By their coordinates, those along u first.
bool is_before(Complex a, Complex b);
bool is_before(const Array<Complex>& a, const Array<Complex>& b);

double distance_to_segment(Complex point, Complex a, Complex b);

// Closed polygons. What they wind around, in either direction, is inside; a polygon of one point or two is that point
// or that segment.
class Outline {
 public:
  // Around triangles, the corners of which follow one another; those at the same place are one vertex. Mirrored
  // triangles count like others, and those without area are points and segments.
  static Outline around_triangles(const Array<Complex>& corners);

  bool is_empty() const { return points_.empty(); }
  const Array<Complex>& points() const { return points_; }
  Box box() const;
  // Around each hole in it.
  Array<Box> hole_boxes() const;

  // All points are multiplied, and then shifted.
  Outline moved(Complex factor, Complex shift) const;
  // Both, as one.
  void append(const Outline& other);
  // With fewer points: no point of what is inside either of both is further than this from the other (Douglas and
  // Peucker 1973).
  Outline simplified(double tolerance) const;

  // Calls visit(a, b) for the ends of each segment.
  template <typename Visit>
  void for_each_segment(Visit visit) const {
    for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
      for (Index i = first_[p]; i < first_[p + 1]; ++i)
        visit(points_[i], points_[i + 1 < first_[p + 1] ? i + 1 : first_[p]]);
    }
  }

 private:
  void add_polygon(const Array<Complex>& polygon);

  Array<Complex> points_;  // polygon by polygon
  Array<Index> first_{0};  // (polygons + 1) the first point of each, and the end
};

}  // namespace lsgp
