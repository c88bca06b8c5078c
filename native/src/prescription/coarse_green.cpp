// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/coarse_green.hpp"

#include "base/memory.hpp"
#include "systems/laplace_solver.hpp"

namespace lsgp {

namespace {

constexpr Index many = 150;            // cones
constexpr Index nodes_of_a_cone = 20;  // on average
constexpr Index worth_while = 2;       // vertices per node

Index node_count(const Array<Index>& cones) { return nodes_of_a_cone * static_cast<Index>(cones.size()); }

// A cone acts most on itself, which depends on the triangles around it.
PerVertex<char> with_neighbors(const HalfedgeMesh& mesh, const Array<Index>& cones) {
  PerVertex<char> out(mesh.vertex_count(), 0);
  for (const Index cone : cones) {
    out[cone] = 1;
    mesh.for_each_outgoing(cone, [&](Index h) { out[mesh.target(h)] = 1; });
  }
  return out;
}

}  // namespace

bool CoarseGreen::pays(const HalfedgeMesh& mesh, const Array<Index>& cones) {
  return static_cast<Index>(cones.size()) > many && mesh.vertex_count() / worth_while > node_count(cones);
}

CoarseGreen::CoarseGreen(const MetricMesh& surface, const BorderConditions& border, const Array<Index>& cones)
    : surface_(surface, with_neighbors(surface.mesh, cones), node_count(cones)) {
  for (const Index cone : cones) nodes_.push_back(surface_.node(cone));
  require_matrix_memory(surface_.node_count(), static_cast<double>(cones.size()), GrowsWith::conditions);
  const std::unique_ptr<LaplaceSolver> laplace = sparse_laplace(surface_.surface(), surface_.at_nodes(border).held);
  columns_ = laplace->solve(Eigen::VectorXd::Zero(surface_.node_count()), nodes_).to_impulses;
}

}  // namespace lsgp
