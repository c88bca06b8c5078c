// SPDX-License-Identifier: GPL-3.0-or-later
// Repair of flipped triangles, with every transition kept as it is.
#pragma once

#include <Eigen/Core>

#include "curvature.hpp"
#include "cut_mesh.hpp"
#include "energies/distortion_energy.hpp"
#include "geometry.hpp"

namespace lsgp {

enum class Effort {
  local,   // growing neighbourhoods of what is flipped
  global,  // and if these do not suffice all vertices at once, at the cost of some whole unfoldings
};

// Moves the vertices around flipped triangles until none is flipped, on growing neighbourhoods, by Newton's method on
// the foldover-free energies (Garanzha et al. 2021) with rest shapes scaled to the prescribed metric and turned by
// frames, (m), then smooths the place with a conformal barrier.  Cones and translations stay, so the seams stay exact.
// position: (copies) u + iv.  fixed: (n) further vertices that stay.  first: the energy that is tried first on each
// neighbourhood: the plain one disturbs a map less that is almost right, the framed one keeps to the frames.  Returns
// the positions with the fewest defects found.
Eigen::VectorXcd untangle(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                          const CutMesh& cut_mesh, const Eigen::VectorXd& rotation, const Curvature& curvature,
                          const Eigen::VectorXd& frames, const std::vector<char>& fixed, Effort effort,
                          DistortionEnergy::Kind first, const Eigen::VectorXcd& position);

}  // namespace lsgp
