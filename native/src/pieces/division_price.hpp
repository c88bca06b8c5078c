// SPDX-License-Identifier: GPL-3.0-or-later
// What a division of a map costs.
#pragma once

#include "division/face_graph.hpp"

namespace lsgp {

// Cost of every island, and additional cost of a sliver, relative to that of cuts as long as the square root of the
// surface's area.
constexpr double cost_of_island = 0.8, cost_of_sliver = 2;
constexpr double sliver = 0.005;  // of the area
// What cuts may cost more for each island that regrouping saves: less than it is worth, since more of them are seen.
constexpr double cuts_for_island = 0.1;

struct DivisionPrice {
  Index islands = 0, slivers = 0;
  double cuts = 0;
  double total() const {
    return cost_of_island * static_cast<double>(islands) + cost_of_sliver * static_cast<double>(slivers) + cuts;
  }
};

// factor: as from relative_cut_factors.  ends: where islands end, on both sides of an edge.
DivisionPrice price_of_division(const MetricMesh& surface, const PerHalfedge<double>& factor,
                                const PerHalfedge<char>& ends);

}  // namespace lsgp
