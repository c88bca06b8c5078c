// SPDX-License-Identifier: GPL-3.0-or-later
// Around what cuts should keep out of.
#pragma once

#include "lsgp/surface.hpp"

namespace lsgp {

// See costly_outline: the shortest closed lines, where what an edge costs counts a little beside its length, so that
// they are neither ragged nor seen more than they have to be. Small parts have no outline of their own.
VertexPairs find_outline(const Surface& surface);

}  // namespace lsgp
