// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "lsgp/surface.hpp"

namespace lsgp {

// From how much of the views around a direction each point on the surface is seen, 0 to 1, (p): views from the half
// space in front, weighed by the cosine to `front`, by depth buffers without perspective. Approximate: to a pixel of
// some thousandths of the extent, and to the number of views.
// points: (p, 3) on the surface.  front: from the surface to who looks at it, not zero.
Eigen::VectorXd visible_share(const Surface& surface, const Positions& points, const Eigen::Vector3d& front);

}  // namespace lsgp
