// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of a finished map in another shape.
#pragma once

#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

enum class PatchShape {
  grid,       // rows and columns of quads, each as wide as its quads are on the surface, on the average
  even_grid,  // rows all of one width, and columns as well
  strip,      // a grid of a single row
  rectangle,  // of a disk: its boundary straight between four corners, with the lengths that it has on the surface
};

struct ShapeRequest {
  std::vector<Index> triangles;  // whose patches get the shape
  PatchShape shape = PatchShape::grid;
  // Of rectangles, vertices: those on the boundary of a patch, which have to be four; none there: where it turns most.
  std::vector<Index> corners;
  // Corners 3 * triangle + corner that stay where they are; patches whose pins do not permit the shape do not get it.
  std::vector<Index> pinned;
};

struct ShapedMap {
  CornerUv corner_uv;             // (3m, 2)
  std::vector<Index> moved;       // triangles with other coordinates, in order
  Index patches = 0;              // that got the shape
  std::vector<Finding> warnings;  // SHAPE_IMPOSSIBLE for each that did not; FLIPPED_TRIANGLES
};

// The patches of some triangles of a map, those that are joined in it, in another shape, along the axes; with the area
// and the middle that they have, and turned as little as that takes. The other triangles of their islands follow with
// least stretch. Quads are as of `find_tubes`.
//
// corner_uv: (3m, 2); triangles with a coordinate that is not finite have no island. Throws SHAPE_IMPOSSIBLE where no
// patch gets the shape, and what `measure_distortion` throws.
LSGP_API ShapedMap shape_patches(const Surface& surface, const CornerUv& corner_uv, const ShapeRequest& request,
                                 const Progress& progress = {});

}  // namespace lsgp
