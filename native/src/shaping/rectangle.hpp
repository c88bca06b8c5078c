// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a disk on that of a rectangle.
#pragma once

#include <array>

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The boundary of a surface, one after the other, and where its vertices lie on that of a rectangle.
struct RectangularBoundary {
  Array<Index> vertices;
  Array<Complex> positions;
};

// To the surface's scale: sides have the mean length of both that are opposite each other, and vertices the same share
// of a side as on the surface. is_corner: (n) marked corners; of those on the boundary there have to be four, or none:
// then it is divided where it turns most, into sides of not too different lengths. Throws SHAPE_IMPOSSIBLE for other
// numbers, and for surfaces that are no disks.
RectangularBoundary lay_on_rectangle(const MetricMesh& surface, const PerVertex<char>& is_corner);

}  // namespace lsgp
