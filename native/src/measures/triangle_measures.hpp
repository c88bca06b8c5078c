// SPDX-License-Identifier: GPL-3.0-or-later
// Areas of triangles on a surface, and how a map stretches them.
#pragma once

#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// (m) in the surface's metric.
PerTriangle<double> areas_of(const Surface& surface);

// Of the linear map of a triangle from its plane to the texture; NaN where it has no area or no coordinates.
struct SingularValues {
  double largest = 0, smallest = 0;
};

PerTriangle<SingularValues> singular_values(const Surface& surface, const CornerUv& corner_uv);

// Of a triangle in the plane, flipped ones too.
double uv_area(const CornerUv& corner_uv, Index triangle);

}  // namespace lsgp
