// SPDX-License-Identifier: GPL-3.0-or-later
// Maps whose nearly straight sides are made straight.
#pragma once

#include <Eigen/Core>

#include "prescription/parallel_transport.hpp"
#include "repair/low_stretch.hpp"
#include "repair/straight_sides.hpp"
#include "systems/poisson_system.hpp"

namespace lsgp {

struct MapWithStraightSides {
  const Eigen::VectorXcd& position;  // (copies) u + iv
  const StraightSides& straight;
};

// The map of least stretch, as from `lower_stretch`, whose boundary has these sides, with all transitions unchanged but
// the translations between islands. It starts from the fit to the Jacobians of the current map among the maps with
// these sides. The coordinate across a side along an axis is the same to the last bit on all of it. Triangles may be
// flipped if sides contradict each other. Throws SOLVER_FAILED.
Eigen::VectorXcd straighten(const CutSurface& surface, const MapTarget& target, const StretchOptions& options,
                            const StepHook& before_step, const MapWithStraightSides& map);

}  // namespace lsgp
