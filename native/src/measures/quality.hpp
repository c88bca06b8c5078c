// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "measures/made_map.hpp"

namespace lsgp {

// How many squares islands are to fill, as in Options.
struct SquareShare {
  double squares = 1;
};

// The number of cones, on several components times the square roots of their shares of the area.
double count_by_area(const SurfaceParts& parts, const std::vector<Index>& cones);

// The quality of a map without its asymmetry; measured once.  progress: of packing.  Throws CANCELLED.
const Quality& measured(MadeMap& made, SquareShare share, const Progress& progress);

// What each component costs in a map, but for the square and symmetry, and its stretch of that.
// parts: components of the map's surface, perhaps without some of its borders.
struct ComponentCosts {
  PerComponent<double> whole, stretch;
};
ComponentCosts costs_on(const SurfaceParts& parts, const MadeMap& made, const Weights& weights);

// Of one island among those of a map.
double price_of_island(const Result& result, const Weights& weights);

// "stretch 1.89 %, 1 island, ..."
std::string in_words(const Quality& quality);

// How the islands of a map may be turned: not where a direction was asked for, and by quarters where features run
// straight.
IslandTurns turns_of(const Result& result);

}  // namespace lsgp
