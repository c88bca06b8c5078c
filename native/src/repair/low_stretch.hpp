// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of less stretch than the conformal one, with the same cone angles and rotations.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/newton.hpp"

namespace lsgp {

// Least symmetric Dirichlet energy against the surface's triangles scaled by e^{(1 - stretch) y}: the conformal map for
// 0, the one of least stretch for 1. Translations move as well, but where fixed vertices hold them.
// curvature: with the log scale y of the conformal map.  fixed: (n) vertices that stay.  importance: (n) or empty,
// factors of the energy around vertices.  position: (copies) a valid map; so is what is returned.
Eigen::VectorXcd lower_stretch(const CutSurface& surface, const ParallelTransport& connection,
                               const Curvature& curvature, double stretch, const Array<char>& fixed,
                               const Eigen::VectorXd& importance, const StepHook& before_step,
                               const Eigen::VectorXcd& position);

// The log scale that is aimed at, (n), with the area of the map at hand.
Eigen::VectorXd scale_at_rest(const CutSurface& surface, const Curvature& curvature, double stretch,
                              const Eigen::VectorXcd& position);

// The weight of every triangle, (m), from those of its vertices, (n) or empty: their mean, relative to the whole
// surface's.
Eigen::VectorXd importance_of_triangles(const HalfedgeMesh& mesh, const Geometry& geometry,
                                        const Eigen::VectorXd& importance);

}  // namespace lsgp
