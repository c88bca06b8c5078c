// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_edges.hpp"

namespace lsgp {

CutEdges::CutEdges(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  first_.reserve(mesh.vertex_count() + 1);
  edges_.reserve(mesh.halfedge_count());
  first_.push_back(0);
  double sum = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    mesh.for_each_outgoing(v, [&](Index h) {
      if (!may_cut(mesh, h)) return;
      edges_.push_back({cut_cost(surface, h), h, mesh.target(h)});
      sum += edges_.back().cost;
    });
    first_.push_back(static_cast<Index>(edges_.size()));
  }
  if (sum > 0) usual_cost_ = sum / static_cast<double>(edges_.size());
}

}  // namespace lsgp
