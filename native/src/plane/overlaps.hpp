// SPDX-License-Identifier: GPL-3.0-or-later
// Overlapping triangles of a layout.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Two triangles whose insides meet, and the area they share.
struct Overlap {
  Index first, second;  // first < second
  double area;
};

// All such pairs of a layout, sorted.  position: (3m) u + iv at the corners, NaN for triangles to leave out. Pairs
// that share less than rounding explains of the smaller one are neighbours and no overlap.
Array<Overlap> find_overlaps(const Eigen::VectorXcd& position);

// The same for a layout without flipped triangles, quicker: only where its border winds around a point twice.
// twin: (3m) the halfedge on the other side of each where the layout runs on, none where it ends.
Array<Overlap> find_overlaps(const Eigen::VectorXcd& position, const Array<Index>& twin);

// Whether there is any such pair in a layout without flipped triangles. Looks at its border alone: an immersed surface
// whose border neither crosses itself nor encloses another part of it lies on itself nowhere.
bool has_overlap(const Eigen::VectorXcd& position, const Array<Index>& twin);

}  // namespace lsgp
