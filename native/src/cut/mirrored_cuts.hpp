// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts that are alike on both sides of a mirror plane.
#pragma once

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "mesh/mirror.hpp"

namespace lsgp {

// What cuts have to join; as for connect_cones.
struct CutTask : MetricMesh {
  const Array<Index>& interior_cones;
  const PerLoop<char>& uncut;
};

// The cuts of connect_cones, but symmetric if the cones are and if that costs at most half as much again.
//
// Symmetric cuts that leave one disk have at most one connected part in the plane, a trunk, and on each side trees that
// meet it in one vertex each: two would enclose a piece with their mirror images. So the trees of one side are found
// with the trunk as one network that costs nothing, and mirrored. If that is too expensive, cuts may meet the plane
// anywhere, and each piece that they enclose loses its most expensive path on one side. Loops around handles are
// mirrored only by chance.
// mirroring: of the mesh, or empty. Throws what connect_cones throws.
CutGraph connect_symmetrically(const CutTask& task, const Mirroring& mirroring);

}  // namespace lsgp
