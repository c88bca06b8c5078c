// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/vertex_pairs.hpp"

namespace lsgp {

VertexPairs to_vertex_pairs(const Array<Index>& ends) {
  return Eigen::Map<const VertexPairs>(ends.data(), ssize(ends) / 2, 2);
}

void append_ends(const Component& component, const PerHalfedge<char>& is_marked, Array<Index>& ends) {
  const HalfedgeMesh& mesh = component.mesh;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_marked[h] || mesh.twin[h] < h) continue;
    ends.push_back(component.source_vertex[mesh.origin(h)]);
    ends.push_back(component.source_vertex[mesh.target(h)]);
  }
}

}  // namespace lsgp
