// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "lsgp/surface.hpp"

namespace lsgp {

// Preferences for the routes of cuts.
struct CutPreferences {
  // From the surface to the viewer: cuts are hidden from the views around this direction. None: visibility has no
  // effect.
  std::optional<Eigen::Vector3d> front;
  bool creases = true;    // edges at which the surface bends
  VertexPairs sharp;      // (s, 2) edges that are creases whatever their angle
  Eigen::VectorXd paint;  // (n) from 0, which attracts cuts, to 1, which repels them; 0.5 or empty: no effect
};

}  // namespace lsgp
