// SPDX-License-Identifier: GPL-3.0-or-later
// Convex hulls and extents of points.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Counter-clockwise (Andrew's monotone chain); a point or two where all of them lie on a line.
Array<Complex> convex_hull(const Eigen::VectorXcd& position);

double area_of_hull(const Array<Complex>& hull);

// The unit vector along the longer side of the smallest box around a convex polygon. One side of that box lies on an
// edge, and as edges turn, the points that touch the others only move on (rotating calipers, Toussaint 1983). Of boxes
// that differ by no more than rounding it is the one that lies on the first edge, counted counter-clockwise from the
// lowest of the leftmost points.
Complex longer_side(const Array<Complex>& polygon);

// Whether a box is at least as wide as high, but for rounding.
bool is_wide(double width, double height);

// The box around points that has a side along a unit vector, in coordinates along and across it.
struct Extent {
  Complex low, high;
  double width() const { return high.real() - low.real(); }
  double height() const { return high.imag() - low.imag(); }
};
Extent extent_along(const Array<Complex>& points, Complex along);

}  // namespace lsgp
