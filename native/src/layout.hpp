// SPDX-License-Identifier: GPL-3.0-or-later
// Islands turned upright, brought to one texel density and placed side by side in the unit square.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

struct Island {
  Eigen::VectorXcd position;  // u + iv of its points, any scale
  double area = 0;            // of its surface in 3D
  double uv_area = 0;         // of its triangles in the plane
};

// Scales every island to its 3D area, turns it so that its bounding box is smallest, puts the islands on shelves
// without overlap and scales all of them alike into the unit square.
void arrange(std::vector<Island>& islands);

}  // namespace lsgp
