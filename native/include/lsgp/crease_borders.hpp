// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lsgp/surface.hpp"

namespace lsgp {

// Where a hard surface may end at its creases.
struct CreaseOptions {
  double angle = 0.7;      // radians between the normals of the two triangles, from which on an edge is a crease
  VertexPairs sharp;       // (s, 2) edges that are creases whatever their angle
  Index most_corners = 0;  // a component whose curvature sits at no more vertices than this is left to cones there
};

}  // namespace lsgp
