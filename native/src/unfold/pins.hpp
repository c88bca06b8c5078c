// SPDX-License-Identifier: GPL-3.0-or-later
// Pinned texture coordinates.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// One pinned copy of a vertex.
struct Pin {
  Index copy;
  Complex position;
};

// Merges pinned corners by copies. Throws PINS_CONFLICT if a copy is pinned to two positions.
Array<Pin> pins_of_copies(const CutMesh& cut_mesh, const Array<std::pair<Index, Complex>>& pinned_corners);

// The map moved onto its pins: by a similarity first, which satisfies two pins, then by the displacement of least
// Dirichlet energy under the transitions. Returns the positions (copies) and the factor by which lengths grew.
// At least two pins.  similarity_only: only the similarity is allowed, as with imposed boundary directions.
// Throws PINS_CONFLICT if the transitions admit no map through all of them.
struct PinnedMap {
  Eigen::VectorXcd position;
  double scale;
};
PinnedMap move_onto_pins(const CutSurface& surface, const Reduction& reduction, const Array<Pin>& pins,
                         bool similarity_only, const Eigen::VectorXcd& position);

}  // namespace lsgp
