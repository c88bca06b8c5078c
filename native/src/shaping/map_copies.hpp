// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as a map has it: with a vertex for each place of a vertex in the map.
#pragma once

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Triangles of a surface, opened where the map is.
struct MapCopies {
  Surface surface;               // its vertices are copies
  Array<Index> source_triangle;  // the caller's
  Array<Index> source_vertex;    // the caller's, of each copy
};

// The triangles of a surface whose coordinates, (3m, 2), are finite.
MapCopies copies_of_map(const Surface& surface, const CornerUv& corner_uv);

// Some of them, by their numbers there.
MapCopies part_of(const MapCopies& copies, const Array<Index>& triangles);

}  // namespace lsgp
