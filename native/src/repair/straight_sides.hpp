// SPDX-License-Identifier: GPL-3.0-or-later
// Nearly straight sides of a map's boundary and the directions that make them straight.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"

namespace lsgp {

// A run of edges of the boundary between corners, or between arcs.
struct StraightSide {
  Array<Index> halfedges;  // the surface on their left
  Complex direction;       // of all of them, a unit vector; exactly along an axis if it nearly is
  double bend;             // the deviation from that direction, radians
};

struct StraightSides {
  Complex turn = 1;       // of the map: aligns the greatest length of sides with the axes; directions are after it
  bool has_axes = false;  // a considerable part of the boundary is along the axes
  Array<StraightSide> sides;

  // Whether any side deviates from its direction by more than rounding.
  bool is_bent() const;
};

// rotation: (cuts) of the map's transitions, radians. Cuts that do not turn by a multiple of a quarter have no straight
// sides, since both could not be along the axes. No sides at all if they would be a small part of the boundary, as on
// scans. most_bend: of sides, radians.
StraightSides find_straight_sides(const CutSurface& surface, const Eigen::VectorXd& rotation,
                                  const Eigen::VectorXcd& position, double most_bend);

// Removes the sides with the largest bends.
void release_bent_sides(StraightSides& straight);

}  // namespace lsgp
