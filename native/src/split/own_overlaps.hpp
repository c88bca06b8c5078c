// SPDX-License-Identifier: GPL-3.0-or-later
// Where a map lies on itself.
#pragma once

#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "pipeline/component_map.hpp"
#include "plane/overlaps.hpp"

namespace lsgp {

struct OwnOverlaps {
  Array<Overlap> pairs;  // of triangles of one piece; flipped ones do not count
  Array<Index> ends;     // halfedges between pieces, one for each edge; empty if the map is one piece
  bool empty() const { return pairs.empty() && ends.empty(); }
};

// A map that lies on itself n times has n squared pairs: beyond `crowded` for each triangle it is halved, by short cuts
// between its far ends, until no piece has that many.  surface: open where the map is cut, and elsewhere.
OwnOverlaps find_own_overlaps(const OpenedSurface& surface, const ComponentMap& map);

// Whether there are any.
bool overlaps_itself(const HalfedgeMesh& mesh, const ComponentMap& map);

// Pairs for each triangle.
constexpr std::size_t crowded = 64;

}  // namespace lsgp
