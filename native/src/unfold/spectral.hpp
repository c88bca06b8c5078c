// SPDX-License-Identifier: GPL-3.0-or-later
// Spectral unfolding (the paper's section 6).
#pragma once

#include <Eigen/Core>

#include "cut/cut_mesh.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// The positions u + iv of all copies: the map of least conformal energy at a given Dirichlet energy (Mullen et al.
// 2008, with a norm that transitions leave invariant). Solved on the cut if the surface has a factor, sparse otherwise.
// Rounding does not choose its rotation: the position farthest from the origin is on the positive u axis.
Eigen::VectorXcd unfold_spectral(const CutSurface& surface, const Reduction& reduction);

}  // namespace lsgp
