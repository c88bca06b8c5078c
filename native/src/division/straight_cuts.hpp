// SPDX-License-Identifier: GPL-3.0-or-later
// Straightens the cuts between parts.
#pragma once

#include <functional>

#include "base/array.hpp"
#include "division/face_graph.hpp"

namespace lsgp {

// Whether a face may not change over to another part.
using IsHeld = std::function<bool(Index face, Index other)>;

// Replaces each cut between two parts by one nearby that turns less, if it is hardly longer; its ends may slide along
// the boundaries of the parts.
// part: connected.
void straighten_cuts(const OpenedSurface& surface, const FaceGraph& graph, const IsHeld& is_held, PerFace<Index>& part);

}  // namespace lsgp
