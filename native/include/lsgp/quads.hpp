// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrangulation by the grid of a seamless layout (the paper's section 8).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lsgp/export.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

using Quads = Eigen::Matrix<Index, Eigen::Dynamic, 4, Eigen::RowMajor>;

// A closed manifold quad mesh, and the positions of its vertices on the surface.
struct QuadMesh {
  Positions positions;           // (v, 3) on the surface
  Quads quads;                   // (q, 4) four distinct vertices each, oriented like the surface's triangles
  std::vector<Index> valences;   // (v) quads around each vertex: a cone's angle in quarter turns, 4 elsewhere
  std::vector<Index> triangles;  // (v) the surface's triangle that contains each vertex
  Positions weights;             // (v, 3) barycentric coordinates in that triangle, at least 0, with sum 1
  // (v) the surface's vertex at each vertex, -1 for none.
  std::vector<Index> surface_vertices;
};

// Traces the grid of a layout over a closed surface: its corners become vertices, its cells quads.
// corner_uv: (3m, 2), of a seamless layout on the square lattice without parity, of any origin; transitions across cuts
// are quarter turns and whole cells. Sides of cuts that deviate by less than a thousandth of a cell are made to match.
// cell: side of a cell in texture coordinates.
// All decisions are exact: coordinates are rounded once, to binary fractions of a cell whose products 64 bits hold.
// Throws WRONG_PARAMETER, NOT_ORIENTABLE, OPEN_SURFACE, INEXACT_SEAMS, FLIPPED_TRIANGLES, CONES_NOT_SNAPPED,
// CONE_ANGLE_RANGE, GRID_TOO_COARSE, CANCELLED; an invalid layout is never extracted in part.
LSGP_API QuadMesh extract_quads(const Surface& surface, const CornerUv& corner_uv, double cell = 1,
                                const Progress& progress = {});

// Throws OPEN_SURFACE or NOT_ORIENTABLE if a surface cannot be covered with quads, whatever its layout, and the errors
// of `parameterize` for invalid surfaces.
LSGP_API void require_closed(const Surface& surface);

}  // namespace lsgp
