// SPDX-License-Identifier: GPL-3.0-or-later
// The order of a connected mesh's triangles by its shape, whatever its numbering.
#pragma once

#include <algorithm>
#include <limits>

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// The halfedges that leave the vertex farthest from the middle and are the longest there; of several as far and as long
// as rounding can tell, those from which a breadth-first search meets what is farther out first. What is left is alike
// all over.
Array<Index> outermost_halfedges(const HalfedgeMesh& mesh);

// For each triangle the halfedge across which a breadth-first search from one reaches it, in that order.
Array<Index> triangles_from(const HalfedgeMesh& mesh, Index first);

// Keeps those whose value is the largest, as far as can be told.
template <typename Of, typename Value>
void keep_largest(Array<Of>& left, double within, Value value) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Of& one : left) most = std::max(most, value(one));
  left.erase(std::remove_if(left.begin(), left.end(), [&](const Of& one) { return value(one) < most - within; }),
             left.end());
}

}  // namespace lsgp
