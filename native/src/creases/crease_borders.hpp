// SPDX-License-Identifier: GPL-3.0-or-later
// Borders along the creases of a hard surface.
//
// A cylinder with its caps has no curvature but along its rims: cut along these, its patches unfold without any
// stretch, where cones would have to stand on every vertex of a rim. What lies between creases is a patch; patches are
// unfolded together across what they share of a border where that is straight, as the faces of a cube are.
#pragma once

#include "base/array.hpp"
#include "lsgp/crease_borders.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// Marks the halfedges, both of an edge, along which a component should end; none where most of its curvature
// lies off its creases and bevels, or at no more vertices than the options say.  crease: on both halfedges; bend:
// (3m) radians between the normals at an edge.
PerHalfedge<char> find_crease_borders(const MetricMesh& surface, const PerHalfedge<char>& crease,
                                      const Eigen::VectorXd& bend, const CreaseOptions& options);

}  // namespace lsgp
