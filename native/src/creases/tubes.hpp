// SPDX-License-Identifier: GPL-3.0-or-later
// Tubes: rings of quads side by side, as of pipes, ropes, horns and walls of revolution.
#pragma once

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// The tubes of a component that consists of them for the most part, or else its handles.
struct ComponentTubes {
  PerHalfedge<char> is_end;  // on both halfedges of the edges at which they end
  Array<Index> triangles;    // of tubes
};

// Between its ends a tube is a ring that unfolds into a strip; what closes it is left to itself.
//
// Quads are as of find_quads. A ring of them is closed across opposite sides, and a tube is a stack of rings joined
// along whole rims. Where the cone that a ring lies on develops into more than half a disk, its inner end is closed
// better than unrolled: tubes end there, and where a ring's rim is folded onto itself. A disk that is a tube, open
// along a line, has no further ends, and neither has a torus, which is a tube only if its rings are of about the same
// girth and it bends so little that a strip is hardly stretched. A handle is a tube that bends as little, whose ends
// the rest of the surface joins, and which is at least as long as its girth; large meshes are not searched for handles.
ComponentTubes find_component_tubes(const MetricMesh& surface);

// What a component is, from one boundary to the other, or open along a line between them: a tube of about the same
// girth all along, as a pipe is, one that tapers, as a horn does, or none. A torus of rings of about the same girth is
// an even one.
enum class TubeShape { none, even, tapering };
TubeShape tube_shape(const MetricMesh& surface);

}  // namespace lsgp
