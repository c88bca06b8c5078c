// SPDX-License-Identifier: GPL-3.0-or-later
// A component's map split where it lies on itself.
#pragma once

#include <vector>

#include "component_map.hpp"

namespace lsgp {

// Opens a map along further cuts until none of its parts overlaps itself (split_overlaps.hpp).  The parts keep their
// places, so that the further cuts begin as the identity.  Flipped triangles lie on their neighbours by nature and are
// let be.  open: (3m) halfedges at which the layout ends, besides the cuts.  Returns how many edges were opened.
Index split_map(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open, ComponentMap& map);

}  // namespace lsgp
