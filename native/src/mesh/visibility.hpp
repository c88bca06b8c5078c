// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "lsgp/surface.hpp"

namespace lsgp {

// The share of the views around a direction that see each point on the surface, 0 to 1, (p): orthographic views from
// the half space in front, weighted by the cosine to `front`, with depth buffers. Approximate: limited by pixels of
// some thousandths of the extent, and by the number of views.
// points: (p, 3) on the surface.  front: from the surface to the viewer, not zero.
Eigen::VectorXd visible_share(const Surface& surface, const Positions& points, const Eigen::Vector3d& front);

}  // namespace lsgp
