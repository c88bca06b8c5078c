// SPDX-License-Identifier: GPL-3.0-or-later
// Continuation of a valid map to other cone angles and other rotations about handles.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "base/array.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/untangle.hpp"

namespace lsgp {

// A point of the path: curvatures and connection of the map there.
struct Waypoint {
  Curvature curvature;
  ParallelTransport connection;
};
struct Path {
  std::function<Waypoint(double share)> at;  // 0 at its beginning, 1 at its end
  Array<Index> aligned{};                    // boundary edges with the direction that they have in the metric
};

struct Continuation {
  double reached;             // share of the path up to which there is a valid map
  Waypoint at;                // the path at that share
  Eigen::VectorXcd position;  // (copies) the map
};

// Continues a map along a path in steps over which it stays valid: its Jacobians, scaled and rotated like the metric
// from one point to the next, are fitted again under the next transitions, every triangle's relative to its scale, and
// flips are repaired. Steps grow on success and shrink on failure.
// map: valid at the beginning of the path; repairs do not move its fixed vertices.
Continuation follow(const CutSurface& surface, const Path& path, Effort effort, const StepHook& before_step,
                    const HeldMap& map);

// The path between two choices of curvatures at the same cones, from the metric's own rotations about handles to the
// chosen ones.
Path path_between(const Curvature& begin, const ParallelTransportChoice& connections, const Curvature& end);

}  // namespace lsgp
