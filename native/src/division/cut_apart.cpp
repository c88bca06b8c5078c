// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/cut_apart.hpp"

#include <utility>

namespace lsgp {

void cut_apart(const HalfedgeMesh& mesh, PerHalfedge<char> is_cut, const PerTriangle<Index>& part,
               const PerPart<Motion>& motion, ComponentMap& map) {
  PerVertex<char> is_node(mesh.vertex_count(), 0);
  for (const Index v : map.cones) is_node[v] = 1;
  CutGraph graph = trace_cuts(mesh, is_node, std::move(is_cut));
  if (map.rotation) {
    Eigen::VectorXd rotation = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(graph.cuts.size()));
    for (std::size_t p = 0; p < graph.cuts.size(); ++p) {
      const Index h = graph.cuts[p].halfedges.front(), before = map.cut_graph.cut_of[h];
      double& r = rotation[static_cast<Eigen::Index>(p)];
      if (before != none) r = (map.cut_graph.runs_forward[h] ? 1 : -1) * (*map.rotation)[before];
      r += motion[part[mesh.twin[h] / 3]].angle - motion[part[h / 3]].angle;
    }
    map.rotation = std::move(rotation);
  }
  CutMesh cut_mesh = cut_open(mesh, graph);
  Eigen::VectorXcd position(cut_mesh.copy_count());
  PerCopy<Index> copy_after(map.cut_mesh.copy_count());
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index before = map.cut_mesh.copy_of_corner[corner], after = cut_mesh.copy_of_corner[corner];
    position[after] = motion[part[corner / 3]](map.position[before]);
    copy_after[before] = after;
  }
  for (Pin& pin : map.pins) pin.copy = copy_after[pin.copy];
  map.position = std::move(position);
  map.cut_graph = std::move(graph);
  map.cut_mesh = std::move(cut_mesh);
}

}  // namespace lsgp
