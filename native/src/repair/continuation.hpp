// SPDX-License-Identifier: GPL-3.0-or-later
// Continuation of a valid map to other cone angles and other rotations about handles.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "base/array.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/untangle.hpp"

namespace lsgp {

// What a map on the way realises.
struct Waypoint {
  Curvature curvature;
  ParallelTransport connection;
};
using Path = std::function<Waypoint(double share)>;  // 0 at its beginning, 1 at its end

struct Continuation {
  double reached;             // share of the path up to which there is a valid map
  Waypoint at;                // the path there
  Eigen::VectorXcd position;  // (copies) the map
};

// Moves a map along a path in steps over which it stays valid: its Jacobians, scaled and turned as the metric is from
// one point to the next, are fitted again under the next transitions, and what flips is repaired. Longer steps where
// that succeeds, shorter ones where it does not.
// map: valid at the beginning of the path; repairs leave its fixed vertices where they are.
Continuation follow(const CutSurface& surface, const Path& path, Effort effort, const StepHook& before_step,
                    const HeldMap& map);

// The path between two choices of curvatures at the same cones, from the metric's own rotations about handles to the
// chosen ones.
Path path_between(const Curvature& begin, const ParallelTransportChoice& connections, const Curvature& end);

}  // namespace lsgp
