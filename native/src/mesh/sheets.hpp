// SPDX-License-Identifier: GPL-3.0-or-later
// Which sheets run on at edges of three or more triangles.
#pragma once

#include "lsgp/surface.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// What is joined already: the parts into which edges of two triangles join them.
struct JoinedParts {
  const PerTriangle<Index>& part;  // none: left out
  const PerTriangle<char>& reversed;
  const PerPart<char>& orientable;
};

// Joins triangles at crowded edges, those of three or more triangles: the two that continue each other best, then the
// best two of those left, as long as they do so smoothly. The others end there, and all do where the best two are a
// corner of which others are no worse, as where two solids touch at an edge. A pair continues the better,
// - the less the surface bends between them, and turns inside out;
// - the less the parts that they are of end elsewhere: a fin has borders of its own, a body has none;
// - if it is one part: one that ended there would have a slit.
// Where the same sheets meet along several edges in a row, all of these are decided as one. No part becomes one-sided.
// Every decision depends on positions and vertex numbers alone, not on the order of triangles or of their corners.
//
// twin: of every halfedge, none where the surface ends; gets those of the pairs.  crowded: the edges to decide.
void continue_sheets(const Surface& surface, const EdgeTable& edges, const PerEdge<char>& crowded,
                     const JoinedParts& joined, PerHalfedge<Index>& twin);

}  // namespace lsgp
