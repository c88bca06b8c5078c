// SPDX-License-Identifier: GPL-3.0-or-later
// Cone angles read off a layout with straight cuts (the paper's section 5).
#pragma once

#include <Eigen/Core>
#include <string>

#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

struct StraightenedLayout {
  Eigen::VectorXd curvature;  // (n) read at every node of the cut graph, 0 elsewhere
  std::string failure;        // why the angles are unusable, or empty
};

// Lays out the opened, originally closed surface with straight sides of cuts and least conformal distortion, resolves
// crossing cuts by swapping the positions of their ends (the paper's Figure 6), and measures each node's angle between
// its cuts.
StraightenedLayout straighten(const CutSurface& surface);

}  // namespace lsgp
