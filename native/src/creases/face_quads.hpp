// SPDX-License-Identifier: GPL-3.0-or-later
// Quads of a triangulated surface.
#pragma once

#include <array>

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// Two triangles; sides counter-clockwise.
struct Quad {
  std::array<Index, 4> side;  // halfedges
};

// Pairs of triangles on both sides of an edge that no cut may follow; where all edges may be cut, on both sides of the
// longest edge of both.
Array<Quad> find_quads(const MetricMesh& surface);

}  // namespace lsgp
