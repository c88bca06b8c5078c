// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds cone curvatures to multiples of a lattice's turn (the paper's section 8).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "prescription/curvature.hpp"
#include "prescription/log_scale.hpp"

namespace lsgp {

// A form in the curvatures, and its price in the logarithm of the L2 stretch.
struct PricedForm {
  const LogScale::Variance& form;
  double price;

  // But for a constant.
  double at(const Eigen::VectorXd& curvature) const {
    return price * curvature.dot(2 * form.gradient + form.hessian * curvature);
  }
};

// The cone curvatures, multiples of 2 pi / rotation_order, of small predicted distortion: from `wanted` rounded under
// Gauss-Bonnet, pairs of cones exchange turns while that lowers the area-weighted variance of the log scale. Given
// angles that are multiples are kept. Angles are bounded by the triangles around them.
// scale: with the cones added, in the same order.  priced: what else counts. Throws SEAMLESS_IMPOSSIBLE.
Eigen::VectorXd quantize_curvature(const ComponentCones& cones, const LogScale& scale, const Eigen::VectorXd& wanted,
                                   int rotation_order, const std::optional<PricedForm>& priced = std::nullopt);

// The multiple of 2 pi / rotation_order nearest to an angle, and its factor.
int turns_of(double angle, int rotation_order);
inline double angle_of_turns(int turns, int rotation_order) { return 2 * M_PI * turns / rotation_order; }

}  // namespace lsgp
