// SPDX-License-Identifier: GPL-3.0-or-later
// Holes of a planar part whose borders come back to where they began, not only to their direction.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "prescription/curvature.hpp"

namespace lsgp {

// A change of the log scale, (n), that has these values along held borders: harmonic between them.
Eigen::VectorXd extend_from_borders(const MetricMesh& surface, const LogScale& scale,
                                    const Eigen::VectorXd& on_borders);

// The log scale changed along the borders of holes, loops about which it turns by -2 pi already, so that going round
// each leads back to where it began: by a constant and by what stretches the border along two directions. Newton's
// method; none where it does not converge.
std::optional<Eigen::VectorXd> close_translations(const MetricMesh& surface, const LogScale& scale,
                                                  const Array<Index>& holes, const Eigen::VectorXd& log_scale);

}  // namespace lsgp
