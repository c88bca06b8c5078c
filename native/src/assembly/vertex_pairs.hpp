// SPDX-License-Identifier: GPL-3.0-or-later
// Edges as pairs of the caller's vertices.
#pragma once

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// The ends of edges, one after the other, as rows.
VertexPairs to_vertex_pairs(const Array<Index>& ends);

// Appends the ends of a component's marked edges between triangles.  is_marked: on both halfedges.
void append_ends(const Component& component, const PerHalfedge<char>& is_marked, Array<Index>& ends);

}  // namespace lsgp
