// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "lsgp/surface.hpp"

namespace lsgp {

// The share of the views around a direction that see each edge, 0 to 1, (e): orthographic views from the half space in
// front, weighted by the cosine to `front`, with depth buffers. Approximate: limited by pixels of some thousandths of
// the extent, and by the number of views. edges: of the surface, seen in the middle or, where they are no longer than
// two pixels, on average at both ends. front: from the surface to the viewer, not zero.
Eigen::VectorXd visible_share(const Surface& surface, const VertexPairs& edges, const Eigen::Vector3d& front);

}  // namespace lsgp
