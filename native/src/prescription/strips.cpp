// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/strips.hpp"

#include "prescription/log_scale.hpp"

namespace lsgp {

namespace {

double predicted_l2(const MetricMesh& tube, const BorderConditions& border) {
  const LogScale scale(tube, border);
  return scale.predicted_l2(scale.evaluate({}));
}

}  // namespace

bool may_be_straight(const MetricMesh& tube) {
  constexpr double most_growth = 1.01;  // of L2 stretch: hardly visible
  return predicted_l2(tube, straight_border(tube, {})) <= most_growth * predicted_l2(tube, free_border(tube.mesh, {}));
}

}  // namespace lsgp
