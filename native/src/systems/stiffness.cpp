// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

// Lengths of shortest paths along edges to the nearest of some vertices, (n).
Eigen::VectorXd distance_to(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Index>& sources) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](Index v, double distance) {
    if (distance >= out[v]) return;
    out[v] = distance;
    queue.emplace(distance, v);
  };
  for (const Index v : sources) reach(v, 0);
  while (!queue.empty()) {
    const double distance = queue.top().first;
    const Index v = queue.top().second;
    queue.pop();
    if (distance > out[v]) continue;
    mesh.for_each_outgoing(v, [&](Index h) {
      reach(mesh.target(h), distance + geometry.length[h]);
      reach(mesh.origin(prev(h)), distance + geometry.length[prev(h)]);
    });
  }
  return out;
}

}  // namespace

Geometry stiffen_around(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<Index>& cones) {
  constexpr double stiffest = 1e4;
  if (cones.empty()) return geometry;
  Eigen::VectorXd weight(mesh.triangle_count());
  const double radius = std::sqrt(geometry.total_area / (M_PI * static_cast<double>(cones.size())));
  const Eigen::VectorXd distance = distance_to(mesh, geometry, cones);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    double mean = 0;
    for (int c = 0; c < 3; ++c) mean += distance[mesh.triangles(f, c)] / 3;
    const double share = radius / std::max(mean, std::numeric_limits<double>::min());
    weight[f] = std::clamp(share * share, 1.0, stiffest);
  }
  return with_weights(geometry, weight);
}

}  // namespace lsgp
