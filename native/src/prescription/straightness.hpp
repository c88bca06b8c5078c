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
  int crossings = 0;          // pairs of sides of cuts that cross and must not
  std::string failure;        // why the angles are unusable, or empty
};

// Lays out the opened, originally closed surface with straight sides of cuts and least conformal distortion, resolves
// crossing cuts by swapping the positions of their ends (the paper's Figure 6), and measures each node's angle between
// its cuts.
Array<StraightenedLayout> straighten(const CutSurface& surface);

// The same with the layout nearest to a flat metric instead of that of least conformal distortion, also on surfaces
// with boundary, whose vertices keep no angle. A second result has the angles of the layout without swaps, which may
// overlap itself, if they obey Gauss-Bonnet.  curvature, log_scale: (n) of the metric.
Array<StraightenedLayout> straighten_beside(const CutSurface& surface, const Eigen::VectorXd& curvature,
                                            const Eigen::VectorXd& log_scale);

}  // namespace lsgp
