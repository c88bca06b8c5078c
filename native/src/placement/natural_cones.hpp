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

}  // namespace lsgp
