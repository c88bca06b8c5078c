// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of less stretch than the conformal one, with the same cone angles and rotations.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/newton.hpp"

namespace lsgp {

struct StretchOptions {
  double stretch;                     // 0 for the conformal map, 1 for the one of least stretch
  const Eigen::VectorXd& importance;  // (n) or empty, factors of the energy around vertices
};

// Least symmetric Dirichlet energy against the surface's triangles scaled by e^{(1 - stretch) y}, y being the target's
// log scale, that of the conformal map. Translations move as well, unless held by fixed vertices. Takes and returns a
// valid map.
Eigen::VectorXcd lower_stretch(const CutSurface& surface, const MapTarget& target, const StretchOptions& options,
                               const StepHook& before_step, const HeldMap& map);

// Newton's method on the symmetric Dirichlet energy, from a map without flips, until further steps gain little.
void relax_stretch(NewtonMinimizer& newton);

// The target log scale, (n), with the area of the current map.
Eigen::VectorXd scale_at_rest(const CutSurface& surface, const Curvature& curvature, double stretch,
                              const Eigen::VectorXcd& position);

// The weight of every triangle, (m), from those of its vertices, (n) or empty: their mean, relative to the whole
// surface's.
Eigen::VectorXd importance_of_triangles(const MetricMesh& surface, const Eigen::VectorXd& importance);

}  // namespace lsgp
