// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of large surfaces, chosen on few of their triangles and then made on all of them.
#pragma once

#include <functional>

#include "choices/border_choice.hpp"
#include "choices/tube_choice.hpp"
#include "measures/made_map.hpp"
#include "measures/objective.hpp"
#include "unwrap/time_limit.hpp"

namespace lsgp {

// Where a surface may end in a map.
struct EndsInMap {
  CreaseBorders creases;
  Tubes tubes;
  VertexPairs outline{0, 2};  // of what the front sees; not on few triangles
  bool may_cut_open = true;   // components without a map
};

// The best map of a surface by an objective.  Throws what `parameterize` and `complete_cones` throw.
using ChooseMap = std::function<Made(const Surface&, const EndsInMap&, Objective&, const Progress&)>;

// Whether a surface is so large that its map is chosen on few of its triangles, and has nothing that these lose: given
// cones, tubes, strokes, factors of lengths, charts without cones, or creases along a lattice.
bool is_kept_when_simplified(const Surface& surface, const GivenCones& given, const EndsInMap& ends,
                             const MapOptions& options);

// A surface with many triangles.
struct LargeSurface {
  const Surface& surface;
  const EndsInMap& ends;
  double target;  // of cones, an L2 stretch
  const TimeLimit& limit;
  const Progress& unlimited;  // goes on when the time is over
};

// The map with the cones, borders and divisions that are best on few triangles. Where it leaves out triangles, has
// further defects, or is stretched by more than both the target and the simplified one, the map is chosen on the whole
// surface as well, unless it is expected to cost more, and the better one is taken. When the time is over before there
// is a map of the whole surface, the best one on few triangles is carried over, which takes longer than the limit, and
// TIME_LIMIT among its findings says so.  Throws what `choose` throws.
Made best_coarse_first(const LargeSurface& large, const ChooseMap& choose, Objective& objective,
                       const Progress& progress);

}  // namespace lsgp
