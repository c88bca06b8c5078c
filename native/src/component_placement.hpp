// SPDX-License-Identifier: GPL-3.0-or-later
// Cones placed automatically on one component.
#pragma once

#include <vector>

#include "components.hpp"
#include "cone_search.hpp"
#include "lsgp/placement.hpp"
#include "monitor.hpp"

namespace lsgp {

// Cones at some vertices, with curvatures.
struct ConeChoice {
  std::vector<Index> vertices;
  Eigen::VectorXd curvature;
  double predicted_l2 = 1;
};

// One component's cones and all that is known of them.
struct PlacedCones {
  ComponentCones cones;  // existing ones first, all with angles
  Curvature curvature;
  bool reached = true;
};

// What cones may be placed on, and how.
struct PlacementTask {
  const HalfedgeMesh& mesh;
  const Geometry& geometry;
  const ComponentCones& existing;
  const std::vector<char>& allowed;    // (n) vertices that cones may be placed at
  const std::vector<Index>& mirrored;  // (n) images in a mirror plane, or empty
};

// findings are added to.  Throws what require_feasible and require_possible throw.
PlacedCones place_component(const PlacementTask& task, const PlacementOptions& options, std::vector<Finding>& findings,
                            Monitor& monitor);

// What one more cone would do to one component.
struct ComponentGains {
  double present_l2 = 1;         // infinite where it needs a cone
  Eigen::VectorXd predicted_l2;  // (n) with a cone there, NaN where none may be
};
ComponentGains component_gains(const PlacementTask& task, Monitor& monitor);

}  // namespace lsgp
