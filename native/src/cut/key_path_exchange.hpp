// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/array.hpp"
#include "cut/cut_network.hpp"

namespace lsgp {

// Makes cuts cheaper, one key path at a time: a path between two nodes (cones, junctions, points of a border) without
// a third between them. Closing it leaves a strip whose two borders are the cuts that remain, and the cheapest path
// across the strip opens it again: a disk stays a disk, with handles too (for trees: Uchoa and Werneck 2012, "Fast
// local search for the Steiner problem in graphs"). The opened surface has to be connected, and every cut to end at a
// node.
void exchange_key_paths(CutNetwork& network);

}  // namespace lsgp
