// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts constructed body by body.
#pragma once

#include "base/array.hpp"
#include "packing/body.hpp"
#include "packing/sliding.hpp"

namespace lsgp {

// A tile to be filled, in texels, and what already lies in it.
struct TileSpace {
  double width, height;
  Array<Outline> obstacles;
};

// Where a body lies: its tile, its pose, and the low corner of that, in texels.
struct Placed {
  int tile = -1;  // it has no place
  int pose = 0;
  Complex at;
};

// Which place is taken: where the rectangle that is open, around bodies or more, grows least, in area and side, the
// lowest, or the nearest to the corner; or where its side grows least, then its area.
enum class PlaceRule { lowest, nearest_corner, least_side };
constexpr int place_rules = 3;

struct ConstructionOptions {
  double gap = 0;  // between bodies, in texels
  // Bodies lie at whole texels. Otherwise they are slid until they touch others.
  bool on_texels = false;
  PlaceRule rule = PlaceRule::lowest;
  // Places that were taken up to a body are not looked at again for those that are hardly smaller.
  bool skips_full_rows = false;
  // Of each side of a tile: this part of it is open from the first body on.
  double open_share = 0;
  bool stops_early = false;  // at the first body without a place
};

struct Constructed {
  Array<Placed> placed;          // (bodies)
  Index missing = 0;             // bodies without a place
  double width = 0, height = 0;  // of the fullest tile: what bodies take of it, from its low corner
  double work = 0;               // how long that took, in about nanoseconds, but the same on every machine
};

// Places bodies one by one in this order, each in the first tile that has room. The rectangle around all of a tile is
// compared with the tile.
// pose: (bodies) the one that a body has to take; -1: any.
Constructed construct(const Array<Array<Pose>>& poses, const Array<TileSpace>& tiles, const Array<Index>& order,
                      const Array<int>& pose, const ConstructionOptions& options);

}  // namespace lsgp
