// SPDX-License-Identifier: GPL-3.0-or-later
// Cones at the corners of a polyhedron, with which it unfolds isometrically.
#pragma once

#include <optional>

#include "placement/cone_chooser.hpp"

namespace lsgp {

// All vertices inside that are not flat, each with its own curvature, where these are few enough for an artist to mark:
// those of boxes, prisms, pyramids, the rims of capped cylinders. The map is isometric then.  sharp: none of them is
// just a bend, as on a smooth surface of few triangles. None otherwise, nor where one may have no cone, a given angle
// or the lattice wants another curvature, or the number of cones that is asked for is another.
enum class Corners { sharp, any };
std::optional<ConeChoice> natural_cones(const ConeChooser& chooser, Corners corners);

}  // namespace lsgp
