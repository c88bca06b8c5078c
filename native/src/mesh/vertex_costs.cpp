// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/vertex_costs.hpp"

#include "mesh/edge_table.hpp"

namespace lsgp {

Eigen::VectorXd costs_at_vertices(const Surface& surface) {
  if (surface.cut_costs.size() == 0) return {};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(surface.positions.rows()), count = sum;
  for (Eigen::Index row = 0; row < surface.edges->rows(); ++row) {
    for (int end = 0; end < 2; ++end) {
      sum[(*surface.edges)(row, end)] += surface.cut_costs[row];
      ++count[(*surface.edges)(row, end)];
    }
  }
  return (sum.array() / count.array().max(1)).matrix();
}

void take_costs(const Eigen::VectorXd& cost, Surface& surface) {
  const EdgeTable edges(surface, PerTriangle<char>(surface.triangles.rows(), 0));
  surface.edges.emplace(edges.count(), 2);
  surface.cut_costs.resize(edges.count());
  for (Index edge = 0; edge < edges.count(); ++edge) {
    const Index h = edges.halfedge(edge, 0);
    const Index a = surface.triangles.data()[h], b = surface.triangles.data()[next(h)];
    surface.edges->row(edge) << a, b;
    surface.cut_costs[edge] = (cost[a] + cost[b]) / 2;
  }
}

}  // namespace lsgp
