// SPDX-License-Identifier: GPL-3.0-or-later
// Further cuts for a layout that lies on itself.
#pragma once

#include <functional>
#include <vector>

#include "geometry.hpp"
#include "overlaps.hpp"
#include "part_cut.hpp"
#include "topology.hpp"

namespace lsgp {

// Opens edges until no two triangles of one part overlap: minimum cuts between what lies on what, so few and short, and
// rather along marked seams and sharp edges.  The parts keep their places, so the transitions stay what they are.
// open: (3m) halfedges at which the layout ends already, on both sides of an edge; receives the further ones.
// Returns how many edges were opened.
Index split_overlaps(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Overlap>& overlaps,
                     CutTaste taste, const std::function<void()>& before_cut, std::vector<char>& open);

}  // namespace lsgp
