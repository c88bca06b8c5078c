// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lsgp/completed_cones.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Whether marked features or creases of hard surfaces are to run along the lattice.
bool follows_features(const Surface& surface, const MapOptions& options);

// Whether marked features are to run along u and v of a map that is not seamless.
bool straightens_marked(const Surface& surface, const MapOptions& options);

// Either of them.
bool aligns_features(const Surface& surface, const MapOptions& options);

// Whether several triangles have a direction of the texture, but not all.
bool has_strokes(const Surface& surface);

}  // namespace lsgp
