// SPDX-License-Identifier: GPL-3.0-or-later
// Overlapping triangles of a layout.
#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// Two triangles whose interiors intersect, and the shared area.
struct Overlap {
  Index first, second;  // first < second
  double area;
};

// All such pairs of a layout, sorted.  position: (3m) u + iv at the corners, NaN for triangles to leave out. Pairs
// that share less of the smaller one than rounding explains are neighbors and do not count.
Array<Overlap> find_overlaps(const Eigen::VectorXcd& position);

// The same for a layout without flipped triangles, faster: only where the winding number of its boundary is 2 or more.
// twin: the halfedge on the other side where the layout continues, none at its boundary.
Array<Overlap> find_overlaps(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin);

// The same; none where there are more than so many, as soon as that is known.  face: only pairs of different faces
// count; empty: all do.
std::optional<Array<Overlap>> find_few_overlaps(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin,
                                                std::size_t most, const PerTriangle<Index>& face);

// Whether there is any such pair in a layout without flipped triangles. Inspects only its boundary: an immersed surface
// with a boundary that neither crosses itself nor encloses another part of it does not overlap itself.
bool has_overlap(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin);

}  // namespace lsgp
