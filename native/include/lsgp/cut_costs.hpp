// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "lsgp/surface.hpp"

namespace lsgp {

// What makes an edge a good place for a cut.
struct CutPreferences {
  // From the surface to who looks at it: cuts hide from the views around this direction. None: they hide from nobody.
  std::optional<Eigen::Vector3d> front;
  bool creases = true;    // edges at which the surface bends
  VertexPairs sharp;      // (s, 2) edges that are creases whatever their angle
  Eigen::VectorXd paint;  // (n) from 0, where cuts should run, to 1, where they should not; 0.5 or empty: no matter
};

}  // namespace lsgp
