// SPDX-License-Identifier: GPL-3.0-or-later
// What is packed: islands, each alone or several that stay together, and the ways in which they may be turned.
#pragma once

#include "base/array.hpp"
#include "lsgp/packing.hpp"
#include "packing/footprint.hpp"
#include "packing/outline.hpp"

namespace lsgp {

constexpr int tiles_in_row = 10;  // from UDIM tile 1001 to 1010

// The lower left corner of a tile, in texture coordinates.
inline Complex corner_of_tile(int tile) {
  const int row = tile / tiles_in_row;
  return Complex(tile % tiles_in_row, row);
}

// How a body is moved: around its origin it is multiplied, and then shifted, in texture coordinates.
struct BodyMotion {
  int tile = -1;
  Complex factor, shift;
};

struct PackedLayout {
  double side = 0;            // of the square that is filled, or by what the area is multiplied; in the unit of bodies
  Array<BodyMotion> motions;  // (bodies) but for those that keep their place
};

struct Body {
  Array<Index> islands;  // their numbers
  Complex low;           // the low corner of its box, as given
  Complex origin;        // of the outline: the same in the unit of lengths
  Outline outline;       // around its origin
  Array<Complex> hull;   // of the outline
  double area = 0;       // of all triangles
  IslandTurns turns = IslandTurns::any;
  bool keeps_scale = false;
  bool keeps_place = false;
};

// The bodies, the largest ones first, in an order that hangs on nothing but their shapes and what they keep.
// length: the unit of outlines, of what corners are given in. quantum: of which the coordinates of outlines are
// multiples; 0: of none.
Array<Body> bodies_of(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options,
                      double length, double quantum);

// The boxes around islands, (islands); turned inside out where none of the triangles is of one.
Array<Box> boxes_of_islands(const CornerUv& corner_uv, const std::vector<Index>& island);

// The area without the margin at its border; if islands have none to fill, a square of side 1 beyond the margin.
UvRectangle inside_margins(const PackingOptions& options, bool has_area);

// Whether most of an outline is parallel to one of the axes.
bool lies_along_axes(const Outline& outline);

// The unit vectors that a body may be turned by: for any turns of outlines that do not lie along the axes, the sides of
// the smallest box and `directions`, a power of two, within each quarter; 0: none of the latter.
Array<Complex> turns_of(const Body& body, int directions, bool also_along_axes);

// A body turned, and rasterized, its box with the low corner at the origin; in texels.
struct Pose {
  Complex turn;   // of length 1
  Complex shift;  // the outline is that of the body, turned and scaled, plus this
  Outline outline;
  double width, height;
  Footprint footprint;
  Array<Box> holes;  // boxes around them
};
// outline: of the body, maybe simplified. scale: texels in its unit. room: in texels; poses that are larger are left
// out, and so are not rasterized. Poses with equal outlines are one.
Array<Pose> poses_of(const Outline& outline, const Array<Complex>& turns, double scale, const Box& room);

}  // namespace lsgp
