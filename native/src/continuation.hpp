// SPDX-License-Identifier: GPL-3.0-or-later
// A valid map followed to other cone angles and other rotations about handles.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "connection.hpp"
#include "untangle.hpp"

namespace lsgp {

// What a map on the way realises.
struct Waypoint {
  Curvature curvature;
  Connection connection;
};
using Path = std::function<Waypoint(double share)>;  // 0 at its beginning, 1 at its end

struct Continuation {
  double reached;             // share of the path up to which there is a valid map
  Waypoint at;                // the path there
  Eigen::VectorXcd position;  // (copies) the map
};

// Moves a map along a path in steps over which it stays valid: its Jacobians, scaled and turned as the metric is from
// one point to the next, are fitted again under the next transitions, and what flips is repaired.  Longer steps where
// that succeeds, shorter ones where it does not.
// position: valid at the beginning of the path.  fixed: (n) vertices that repairs leave where they are.
Continuation follow(const CutSurface& surface, const Path& path, const std::vector<char>& fixed, Effort effort,
                    const StepHook& before_step, const Eigen::VectorXcd& position);

// The path between two choices of curvatures at the same cones, from the metric's own rotations about handles to the
// chosen ones.
Path path_between(const Curvature& begin, const ConnectionChoice& connections, const Curvature& end);

}  // namespace lsgp
