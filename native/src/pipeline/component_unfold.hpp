// SPDX-License-Identifier: GPL-3.0-or-later
// Unfolds a component by the method that its borders and cones allow (the paper's section 6).
#pragma once

#include <vector>

#include "base/array.hpp"
#include "lsgp/errors.hpp"
#include "pipeline/component_map.hpp"
#include "prescription/parallel_transport.hpp"

namespace lsgp {

// The method asked for, or the Poisson unfolding where the spectral one is ill-posed; findings are added to.
UnfoldMethod usable_unfold(const HalfedgeMesh& mesh, const ComponentCones& cones, UnfoldMethod asked,
                           std::vector<Finding>& findings);

// The boundary edges whose direction in the layout is imposed: halfedges.
Array<Index> aligned_edges(const HalfedgeMesh& mesh, const ComponentCones& cones);

// Each returns the positions u + iv of all copies.

// The Poisson unfolding with the prescribed metric; aligned edges get exact directions.  surface: the map's.
Eigen::VectorXcd unfold_poisson(const CutSurface& surface, const ComponentMap& map, const ComponentCones& cones,
                                const ParallelTransport& connection);

// The fit to the prescribed Jacobians with every triangle's error relative to its scale. One more factorization.
Eigen::VectorXcd unfold_relatively(const CutSurface& surface, const Curvature& curvature,
                                   const ParallelTransport& connection);

}  // namespace lsgp
