// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nearest_distance.hpp"

#include <limits>
#include <utility>

#include "base/least_first.hpp"

namespace lsgp {

NearestDistance::NearestDistance(const MetricMesh& surface)
    : mesh_(surface.mesh),
      geometry_(surface.geometry),
      far_(Eigen::VectorXd::Constant(surface.mesh.vertex_count(), std::numeric_limits<double>::infinity())) {}

void NearestDistance::add(const Array<Index>& vertices) {
  using Reached = std::pair<double, Index>;
  LeastFirst<Reached> reached;
  const auto reach = [&](Index v, double distance) {
    if (!(distance < far_[v])) return;
    far_[v] = distance;
    reached.emplace(distance, v);
  };
  for (const Index v : vertices) reach(v, 0);
  while (!reached.empty()) {
    const auto [distance, v] = reached.top();
    reached.pop();
    if (distance > far_[v]) continue;
    mesh_.for_each_outgoing(v, [&, from = distance](Index h) {
      reach(mesh_.target(h), from + geometry_.length[h]);
      // The last edge around a boundary vertex has no outgoing halfedge.
      if (mesh_.twin[prev(h)] == none) reach(mesh_.origin(prev(h)), from + geometry_.length[prev(h)]);
    });
  }
}

}  // namespace lsgp
