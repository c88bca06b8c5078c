// SPDX-License-Identifier: GPL-3.0-or-later
// A metric whose angles add up as they have to, found on the lengths of edges.
#pragma once

#include <optional>

#include "prescription/curvature.hpp"
#include "repair/newton.hpp"

namespace lsgp {

// A metric of the same triangles with these sums of angles and little shear, by sequential quadratic programming from
// the surface's own metric: its sums are off, but no triangle ever flips, and no vertex winds once too often, as it may
// in a map without flips. None if no such metric is found.  Throws SolverFailure.
std::optional<Geometry> find_flat_metric(const MetricMesh& surface, const AngleSums& wanted,
                                         const StepHook& before_step);

}  // namespace lsgp
