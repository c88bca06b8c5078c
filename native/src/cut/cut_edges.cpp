// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_edges.hpp"

#include <numeric>

#include "base/thread_team.hpp"

namespace lsgp {

CutEdges::CutEdges(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  first_.assign(mesh.vertex_count() + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) first_[mesh.origin(h) + 1] += may_cut(mesh, h);
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  edges_ = std::unique_ptr<Edge[]>(new Edge[static_cast<std::size_t>(first_.back())]);
  for_each_at_once(mesh.vertex_count(), [&](Index v) {
    Edge* edge = edges_.get() + first_[v];
    mesh.for_each_outgoing(v, [&](Index h) {
      if (may_cut(mesh, h)) *edge++ = {cut_cost(surface, h), h, mesh.target(h)};
    });
  });
  double sum = 0;
  for (Index i = 0; i < first_.back(); ++i) sum += edges_[static_cast<std::size_t>(i)].cost;
  if (sum > 0) usual_cost_ = sum / static_cast<double>(first_.back());
}

}  // namespace lsgp
