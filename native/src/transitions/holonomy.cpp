// SPDX-License-Identifier: GPL-3.0-or-later
#include "transitions/holonomy.hpp"

namespace lsgp {

NodeGraph build_node_graph(const HalfedgeMesh& mesh, const CutGraph& cut_graph,
                           const std::function<double(Index)>& root_rank) {
  NodeGraph nodes;
  PerVertex<Index> node_of_vertex(mesh.vertex_count(), none);
  PerLoop<Index> node_of_loop(mesh.boundary_loops.size(), none);
  const auto node_at = [&](Index v) {
    const Index loop = mesh.loop_of_vertex[v];
    Index& node = loop == none ? node_of_vertex[v] : node_of_loop[loop];
    if (node == none) {
      node = static_cast<Index>(nodes.vertex.size());
      nodes.vertex.push_back(loop == none ? v : none);
      nodes.loop.push_back(loop);
    }
    return node;
  };
  for (const Cut& cut : cut_graph.cuts) {
    nodes.tail.push_back(node_at(cut.tail));
    nodes.head.push_back(node_at(cut.head));
  }
  const Index node_count = static_cast<Index>(nodes.vertex.size());
  nodes.parent_cut.assign(node_count, none);
  nodes.in_tree.assign(cut_graph.cuts.size(), 0);
  if (node_count == 0) return nodes;

  PerNode<Array<Index>> cuts_at(node_count);
  for (std::size_t p = 0; p < cut_graph.cuts.size(); ++p) {
    cuts_at[nodes.tail[p]].push_back(static_cast<Index>(p));
    cuts_at[nodes.head[p]].push_back(static_cast<Index>(p));
  }
  const auto rank = [&](Index node) { return nodes.vertex[node] == none ? 2.0 : root_rank(nodes.vertex[node]); };
  Index root = 0;
  for (Index i = 1; i < node_count; ++i) {
    if (rank(i) > rank(root)) root = i;
  }
  PerNode<char> seen(node_count, 0);
  seen[root] = 1;
  nodes.order.assign(1, root);
  for (std::size_t i = 0; i < nodes.order.size(); ++i) {
    for (const Index p : cuts_at[nodes.order[i]]) {
      const Index other = nodes.tail[p] == nodes.order[i] ? nodes.head[p] : nodes.tail[p];
      if (seen[other]) continue;
      seen[other] = 1;
      nodes.parent_cut[other] = p;
      nodes.in_tree[p] = 1;
      nodes.order.push_back(other);
    }
  }
  return nodes;
}

Eigen::VectorXd find_rotations(const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                               const Eigen::VectorXd& free_rotation) {
  Eigen::VectorXd rotation = free_rotation;
  Eigen::VectorXd remaining = -node_curvature;  // to be balanced by the node's parent cut
  for (Eigen::Index p = 0; p < rotation.size(); ++p) {
    if (nodes.in_tree[p]) continue;
    remaining[nodes.tail[p]] -= rotation[p];
    remaining[nodes.head[p]] += rotation[p];
  }
  for (std::size_t i = nodes.order.size(); i-- > 1;) {
    const Index node = nodes.order[i], p = nodes.parent_cut[node];
    const bool leaves = nodes.tail[p] == node;
    rotation[p] = leaves ? remaining[node] : -remaining[node];
    const Index parent = leaves ? nodes.head[p] : nodes.tail[p];
    remaining[parent] += remaining[node];
  }
  return rotation;
}

}  // namespace lsgp
