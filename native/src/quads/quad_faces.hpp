// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the grid as quads of a mesh.
#pragma once

#include "lsgp/quads.hpp"
#include "mesh/topology.hpp"
#include "quads/grid_edges.hpp"

namespace lsgp {

// Walks around every cell; vertices have the grid's numbers. Checks that all cells have four sides and the mesh the
// surface's Euler characteristic, otherwise throws SOLVER_FAILED. Throws GRID_TOO_COARSE if a quad would have a vertex
// twice or two vertices share more than one edge, with the surface's triangles that contain these vertices.
Quads walk_faces(const HalfedgeMesh& mesh, const GridVertices& vertices, const GridEdges& edges);

}  // namespace lsgp
