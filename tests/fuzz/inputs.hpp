// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces, cones and options out of bytes: mostly sound, at times with anything changed.
#pragma once

#include "bytes.hpp"
#include "lsgp/lsgp.hpp"

lsgp::Surface make_surface(Bytes& bytes);
lsgp::Cones make_cones(Bytes& bytes, const lsgp::Surface& surface);
lsgp::Options make_options(Bytes& bytes, const lsgp::Surface& surface);
lsgp::Pins make_pins(Bytes& bytes, const lsgp::Surface& surface);
lsgp::PlacementOptions make_placement_options(Bytes& bytes);

// Texture coordinates that may have nothing to do with the surface, at times of another length.
lsgp::CornerUv make_corner_uv(Bytes& bytes, const lsgp::Surface& surface);
