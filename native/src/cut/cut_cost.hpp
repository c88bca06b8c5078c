// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of a cut: permitted edges and their weighted lengths.
#pragma once

#include <cmath>

#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// Cuts are cheaper along edges at which the normals turn by more than this, radians.
constexpr double smooth_bend = 30 * M_PI / 180;

// A cut edge is an interior edge of the original mesh.
inline bool may_cut(const HalfedgeMesh& mesh, Index h) { return mesh.twin[h] != none && mesh.cuttable[h]; }

// The length of an edge times its factor. Seams cost nothing, since they are opened anyway.
inline double cut_cost(const MetricMesh& surface, Index h) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  if (mesh.seam[h]) return 0;
  return mesh.cut_factor.empty() ? geometry.length[h] : mesh.cut_factor[h] * geometry.length[h];
}

}  // namespace lsgp
