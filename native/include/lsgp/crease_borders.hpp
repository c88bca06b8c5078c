// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lsgp/surface.hpp"

namespace lsgp {

// Which creases a hard surface may be cut at.
struct CreaseOptions {
  static constexpr double usual_angle = 0.7;
  static constexpr double usual_share = 0.8;

  double angle = usual_angle;        // least angle between the normals at a crease, radians
  VertexPairs sharp;                 // (s, 2) edges that are creases whatever their angle
  Index most_corners = 0;            // components with curvature at no more vertices than this are left to cones there
  double least_share = usual_share;  // of a component's curvature, on its creases
};

}  // namespace lsgp
