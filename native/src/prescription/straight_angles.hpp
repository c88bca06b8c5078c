// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's rule for cone angles, with other trees of cuts where the first one does not allow it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cut/cut_graph.hpp"
#include "lsgp/errors.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

class ComponentSystem;

struct StraightAngles {
  Eigen::VectorXd curvature;  // of the cones, or empty: no tree allows straight cuts
  // The cuts that are straight, or none: those of the system.
  std::optional<CutGraph> cuts;
  std::vector<Finding> findings;
};

// Reads cone angles off layouts with straight cuts: for each tree the paper's of least conformal distortion, then the
// one nearest to the metric of least distortion. The system's cuts come first, then those of randomly varied costs,
// each varied further where that leaves fewer crossings, until angles are usable and stretch little more than those of
// least distortion; otherwise the usable ones with the least stretch count. Angles at junctions of the cuts are
// distributed equally over the cones. On surfaces with boundary, which is free, the conformal layout is one of many and
// is left out.
// least: the curvatures of least distortion.
StraightAngles find_straight_angles(ComponentSystem& system, const ComponentCones& cones, const Eigen::VectorXd& least);

}  // namespace lsgp
