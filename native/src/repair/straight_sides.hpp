// SPDX-License-Identifier: GPL-3.0-or-later
// Nearly straight sides of a map's boundary, nearly straight creases inside, and the directions that make them
// straight.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "lsgp/result.hpp"
#include "repair/feature_lines.hpp"

namespace lsgp {

// A run of edges of the boundary, or of a crease inside, between corners or between arcs.
struct StraightSide {
  Array<Index> halfedges;  // of the boundary: the surface on their left
  Complex direction;       // of all of them, a unit vector; exactly along an axis if it nearly is
  double bend;             // the deviation from that direction, radians
  double length;
  bool is_inside;          // of a crease
  bool is_marked = false;  // a feature, or a part of one

  // Whether it deviates from its direction by more than rounding.
  bool is_bent() const { return bend > 1e-9; }
  // Whether the same edges get the same direction.
  bool operator==(const StraightSide& b) const { return halfedges == b.halfedges && direction == b.direction; }
};

struct StraightSides {
  Complex turn = 1;       // of the map: aligns the greatest length of sides with the axes; directions are after it
  bool has_axes = false;  // a considerable part of the boundary is along the axes
  Array<StraightSide> sides;
  PerHalfedge<ReleaseReason> reasons{};  // why marked features are not among the sides; empty without

  // Of those that are marked.
  double marked_length() const {
    double out = 0;
    for (const StraightSide& side : sides) out += side.is_marked ? side.length : 0;
    return out;
  }

  bool is_bent() const {
    return std::any_of(sides.begin(), sides.end(), [](const StraightSide& side) { return side.is_bent(); });
  }
};

// Marked features are along the axes nearest to them, after a rotation that aligns them, from corner to corner.
// rotation: (cuts) of the map's transitions, radians. Cuts that do not turn by a multiple of a quarter have no straight
// sides, since both could not be along the axes. No sides at all if they would be a small part of the boundary, as on
// scans.
struct SideLimits {
  double most_bend;   // radians
  bool with_creases;  // inside
  bool only_marked;   // features, which may be bent as far as they are nearer to one axis than to the other
  LineReading reading = LineReading::nearest;  // of marked features
};
StraightSides find_straight_sides(const CutSurface& surface, const Eigen::VectorXd& rotation,
                                  const Eigen::VectorXcd& position, const SideLimits& limits);

// For every island the rotation, up to quarters, that aligns the greatest length of its straight sides with the axes,
// if that is a considerable part of its boundary.  island: of each.
Array<std::optional<Complex>> turns_to_axes(const HalfedgeMesh& mesh, const CutMesh& cut_mesh,
                                            const Eigen::VectorXcd& position, const PerTriangle<Index>& island);

// The ends of what is tried first.  straight: marked features that are already.
struct SideOrder {
  std::ptrdiff_t straight, marked, border;
};

// Orders the sides by what they cost relative to their length, marked features first and creases inside last. A side
// that is turned or bowed by an angle costs the square of the angle times the square of its length.
SideOrder sort_by_cost(StraightSides& straight);

}  // namespace lsgp
