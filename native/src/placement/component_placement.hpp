// SPDX-License-Identifier: GPL-3.0-or-later
// Cones placed automatically on one component.
#pragma once

#include <optional>
#include <vector>

#include "base/progress_monitor.hpp"
#include "lsgp/placement.hpp"
#include "placement/shortfalls.hpp"
#include "prescription/component_system.hpp"
#include "search/cone_chooser.hpp"

namespace lsgp {

// One component's cones and their measurements.
struct ConePlacement {
  ComponentCones cones;  // existing ones first, all with angles
  Curvature curvature;
  double mapped_l2 = 1;  // of the map, infinite where it is not valid
  int maps = 0;          // that were made
  std::optional<MissingCones> missing;
  bool reached = true;
  bool are_too_many = false;  // more cones than are wanted, without a map
};

struct PlacedCones : ConePlacement {
  KeptSystem system;  // of the cones; none if the latest map was not theirs
};

// findings are added to. Throws what require_feasible, require_possible and connect_cones throw, and SOLVER_FAILED
// where cones that were placed would leave angles or seams off.
PlacedCones place_component(const PlacementTask& task, const PlacementOptions& options, std::vector<Finding>& findings,
                            ProgressMonitor& monitor);

// The effect of one more cone on one component.
struct ComponentGains {
  double present_l2 = 1;         // infinite where it needs a cone
  Eigen::VectorXd predicted_l2;  // (n) with a cone there, NaN where none may be
  // The vertex that gains most, also where stretches are too large to be told apart; where cuts have costs, of those
  // that gain at least half as much the one that gains most by its price.
  Index best = none;
};
ComponentGains component_gains(const PlacementTask& task, ProgressMonitor& monitor);

}  // namespace lsgp
