// SPDX-License-Identifier: GPL-3.0-or-later
// The topology of the parts into which edges divide a surface.
#pragma once

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct PartTopology {
  int euler = 0;  // V - E + F
  int borders = 0;
  bool is_disk() const { return borders == 1 && euler == 1; }
  bool is_planar() const { return borders > 0 && euler == 2 - borders; }  // a disk, with or without holes
};

// Those of label_parts.  open: on both halfedges.
PerPart<PartTopology> measure_parts(const HalfedgeMesh& mesh, const PerHalfedge<char>& open);

}  // namespace lsgp
