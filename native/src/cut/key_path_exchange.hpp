// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/array.hpp"
#include "cut/cut_network.hpp"

namespace lsgp {

// Makes cuts cheaper, one key path at a time: a path between two nodes (cones, junctions, boundary points) without a
// third node between them. Closing it leaves a strip bounded by the remaining cuts, and the cheapest path across the
// strip opens it again: a disk stays a disk, also around handles (for trees: Uchoa and Werneck 2012, "Fast local search
// for the Steiner problem in graphs"). Without handles junctions are exchanged as well (star_exchange.hpp). The opened
// surface has to be connected, and every cut has to end at a node.
void shorten_cuts(CutNetwork& network);

}  // namespace lsgp
