// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds cone curvatures to multiples of a lattice's turn (the paper's section 8).
#pragma once

#include <Eigen/Core>

#include "prescription/curvature.hpp"

namespace lsgp {

// The cone curvatures, multiples of 2 pi / rotation_order, of small predicted distortion: from `wanted` rounded under
// Gauss-Bonnet, pairs of cones exchange turns while that lowers the area-weighted variance of the log scale. Given
// angles that are multiples are kept. Angles are bounded by the triangles around them.
// scale: with the cones added, in the same order. Throws SEAMLESS_IMPOSSIBLE.
Eigen::VectorXd quantize_curvature(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale,
                                   const Eigen::VectorXd& wanted, int rotation_order);

// The multiple of 2 pi / rotation_order nearest to an angle, and its factor.
int turns_of(double angle, int rotation_order);
inline double angle_of_turns(int turns, int rotation_order) { return 2 * M_PI * turns / rotation_order; }

}  // namespace lsgp
