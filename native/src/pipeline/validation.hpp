// SPDX-License-Identifier: GPL-3.0-or-later
// Validation of the caller's arrays, before any topology is built.
#pragma once

#include <cstddef>
#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Checks that so many elements can be counted, with three corners each, in an Index. Throws WRONG_PARAMETER.
void require_countable(std::ptrdiff_t count, const char* what);

// Checks that pairs refer to vertices. Throws INDEX_OUT_OF_RANGE.
void require_vertices(const Surface& surface, const VertexPairs& pairs, const char* what);

// Checks that triangles, edges and seams refer to vertices. Throws EMPTY_MESH, INDEX_OUT_OF_RANGE, BAD_FACE,
// WRONG_PARAMETER.
void require_connectivity(const Surface& surface);

// Throws EMPTY_MESH, INDEX_OUT_OF_RANGE, BAD_FACE, NON_FINITE_POSITION, SCALE_RANGE, DEGENERATE_MESH,
// WRONG_PARAMETER.
void require_valid(const Surface& surface);

// Checks that every corner of a triangle has texture coordinates. Throws WRONG_PARAMETER.
void require_one_each(const Surface& surface, const CornerUv& corner_uv);

// For the vertices of one component. Throws SCALE_RANGE if a few of them are so far from all others that distances lose
// all precision, as in meshes whose infinite coordinates Blender has replaced.
void require_comparable(const Positions& positions);

// Checks that cones are valid vertices and that angles match cones. Throws CONE_INDEX, ANGLE_COUNT.
void require_vertices(const Surface& surface, const Cones& cones);

// Throws CONE_INDEX, CONE_DUPLICATE, CONE_NOT_ON_SURFACE, ANGLE_COUNT, CONE_ANGLE_NON_FINITE, CONE_ANGLE_RANGE.
void require_valid(const Surface& surface, const Cones& cones);

// Throws WRONG_PARAMETER.
void require_valid(const Options& options);

// The same, also for options that are incompatible with pins. Throws PINS_CONFLICT.
void require_valid(const Options& options, const Pins& pins);

// Throws WRONG_PARAMETER if seams leave no room for cones, which need cuts.
void require_room_for_cones(SeamMode seams);

// Throws WRONG_PARAMETER.
void require_valid(const PlacementOptions& options);

// Throws PIN_INDEX, PIN_NON_FINITE.
void require_valid(const Surface& surface, const Pins& pins);

// Of islands or groups, one for each triangle, -1 for none: there are no more numbers than triangles, so that no table
// of them is large. what: "an island". Throws INDEX_OUT_OF_RANGE.
void require_numbers(const std::vector<Index>& numbers, const char* what);

}  // namespace lsgp
