// SPDX-License-Identifier: GPL-3.0-or-later
// Feasibility of cone angles, decided by a maximum flow.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// Every triangle has half a turn of angle for its corners, every vertex wants a given sum from the corners around it:
// a transport problem, solved as a maximum flow. Where it has no solution with all corners positive, no triangles laid
// out in the plane have these angles, whatever their shapes.
// angle: (n) wanted, radians.  is_free: vertices that take whatever they get.  guess: (3m) angles of corners from which
// the flow starts; the result does not depend on it, but the time does.  named: cones with given angles.
// Throws ANGLES_IMPOSSIBLE with the cones whose triangles cannot carry their angles, or have to carry more; where none
// of these is the cause, with the other vertices whose triangles carry too little or too much, of which one has to be
// free.
void require_possible_angles(const HalfedgeMesh& mesh, const Eigen::VectorXd& angle, const PerVertex<char>& is_free,
                             const Eigen::VectorXd& guess, const Array<Index>& named);

}  // namespace lsgp
