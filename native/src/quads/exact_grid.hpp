// SPDX-License-Identifier: GPL-3.0-or-later
// A seamless layout in integers, in which both sides of every edge match exactly.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "quads/grid_point.hpp"

namespace lsgp {

// Every triangle has its own chart, in which its corners are counter-clockwise.
struct ExactGrid {
  int bits = 0;                        // a cell's side is 2^bits
  PerHalfedge<GridPoint> at;           // corners
  PerHalfedge<GridTransition> across;  // from a halfedge's triangle to its twin's
  PerVertex<int> quarter_turns;        // the angle of each vertex

  std::int64_t cell() const { return std::int64_t{1} << bits; }
  bool is_corner(GridPoint p) const { return (p.x & (cell() - 1)) == 0 && (p.y & (cell() - 1)) == 0; }

  // The two sides of a corner's triangle, seen from there, counter-clockwise.
  GridPoint first_side(Index corner) const { return at[next(corner)] - at[corner]; }
  GridPoint second_side(Index corner) const { return at[prev(corner)] - at[corner]; }
  // Whether a grid direction leads from a corner into its triangle or along the first side: around a vertex each
  // direction belongs to one corner.
  bool leads_into(Index corner, int direction) const {
    const GridPoint way = axis(direction);
    return is_from(first_side(corner), way) && cross(way, second_side(corner)) > 0;
  }
  // Whether a grid direction leads from a point of a halfedge into its triangle or along it.
  bool leads_beside(Index halfedge, int direction) const { return is_from(first_side(halfedge), axis(direction)); }
};

// mesh: closed. uv: (3m) of its corners, in cells. Each vertex is rounded once, and its other corners follow from the
// first by the turns and whole cells that the layout has across its edges.
// Throws INEXACT_SEAMS for other transitions, FLIPPED_TRIANGLES, CONES_NOT_SNAPPED, CONE_ANGLE_RANGE; WRONG_PARAMETER
// if there are too many cells.
ExactGrid build_exact_grid(const HalfedgeMesh& mesh, const Eigen::VectorXcd& uv);

}  // namespace lsgp
