// SPDX-License-Identifier: GPL-3.0-or-later
// Cones at the corners of a polyhedron, with which it unfolds isometrically.
#pragma once

#include <optional>

#include "search/cone_chooser.hpp"

namespace lsgp {

// All interior vertices that are not flat, each with its own curvature, if there are few enough for an artist to mark:
// those of boxes, prisms, pyramids, the rims of capped cylinders. The map is then isometric.  sharp: none of them is a
// mere bend, as on a smooth surface of few triangles.  all: however many, up to one for `least_vertices_a_cone`. None
// otherwise, or if a cone is not allowed at one of them, a given angle or the lattice requires another curvature, or
// another number of cones is requested.
enum class Corners { sharp, any, all };
std::optional<ConeChoice> natural_cones(const ConeChooser& chooser, Corners corners);

// One cone in the middle of each rounded corner, as those of a box with bevels: a connected set of vertices that are
// not flat, on an otherwise flat or singly curved closed surface without cones. The map is nearly isometric if the
// corners are small. None if there are too many, or if one has hardly any curvature or, with a lattice, none that the
// lattice has.
std::optional<ConeChoice> rounded_corner_cones(const ConeChooser& chooser);

}  // namespace lsgp
