// SPDX-License-Identifier: GPL-3.0-or-later
// Packing: islands moved, turned and scaled so that they fill a rectangle.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lsgp/export.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

enum class IslandTurns { none, quarters, any };

// How long better layouts are looked for; none is worse than that which is given, or than with less effort. The same
// effort gives the same layout on every machine.
enum class PackingEffort { quick, good, best };

// What an island keeps.
struct IslandLock {
  bool place = false;  // all of it
  bool rotation = false;
  bool scale = false;
};

struct UvRectangle {
  double left = 0, bottom = 0, right = 1, top = 1;
};

struct PackingOptions {
  // Around each island, in texture coordinates; the gap between two is twice as wide.
  double margin = 4.0 / 1024;
  // Islands get the scale, the same for all, with which they fill the area. Otherwise they keep their size.
  bool fill = true;
  IslandTurns turns = IslandTurns::any;
  PackingEffort effort = PackingEffort::good;
  // How long `best` goes on, seconds, but at least until there is the layout of `good`; none: until its own end, which
  // hangs on islands alone.
  std::optional<double> seconds;
  // Where islands are put. None: the unit square; if islands keep their size and none its place, the smallest square
  // that begins at the origin.
  std::optional<UvRectangle> area;
  // Squares, from the unit square on ten in a row as UDIM tiles, that islands are spread over; fewer are used if more
  // do not make islands larger.
  int tiles = 1;
  // The side of square blocks, in texture coordinates: the box of every island has its low corner on the corner of one,
  // and no block is shared by two islands. 0: none.
  double snap = 0;
  // (islands) Islands of one number stay together as they are; -1: alone. Or empty.
  std::vector<Index> groups;
  // (islands) Or empty.
  std::vector<IslandLock> locks;
};

// The texture coordinates of islands, each moved as a whole by a turn, a translation and a scale, so that they keep
// their margins.  island: (m) the number of each triangle's island, -1: it does not move. WRONG_PARAMETER, with the
// triangles of the islands concerned: coordinates that are not finite, margins without room, what does not fit, margins
// and areas that leave numbers no digits for the shapes of islands. packed_quickly: the result of the same call with
// the effort `quick`, if it is known, so that it is not computed again; with `fill`, one tile, and without locks or
// blocks.
LSGP_API CornerUv pack_islands(const CornerUv& corner_uv, const std::vector<Index>& island,
                               const PackingOptions& options = {}, const Progress& progress = {},
                               const CornerUv* packed_quickly = nullptr);

// The margin where none is asked for: that of PackingOptions or, of so many islands that the gaps between them would
// take more than a quarter of their room, as much less as makes it a quarter. At least half a texel of a texture of
// 1024, so that there is one between two islands.  tiles: as in PackingOptions.  Throws WRONG_PARAMETER for what
// `pack_islands` refuses.
LSGP_API double usual_margin(const CornerUv& corner_uv, const std::vector<Index>& island, int tiles = 1);

// The islands of which nothing outside can see any triangle: from no point of a sample of each does a ray, in any of 64
// directions, leave the surface, which hides what is behind it from both sides.  island: (m) as above.
// Throws what `parameterize` throws for surfaces, WRONG_PARAMETER and INDEX_OUT_OF_RANGE.
LSGP_API std::vector<Index> hidden_islands(const Surface& surface, const std::vector<Index>& island,
                                           const Progress& progress = {});

}  // namespace lsgp
