// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the grid as quads of a mesh.
#pragma once

#include "lsgp/quads.hpp"
#include "mesh/topology.hpp"
#include "quads/grid_edges.hpp"

namespace lsgp {

// Walks around every cell, vertices as the grid's are numbered. Makes sure that all have four sides and the mesh the
// surface's Euler characteristic: otherwise throws SOLVER_FAILED. Throws GRID_TOO_COARSE where a quad would have a
// vertex twice or two vertices more than one edge, and names the surface's triangles that these vertices are on.
Quads walk_faces(const HalfedgeMesh& mesh, const GridVertices& vertices, const GridEdges& edges);

}  // namespace lsgp
