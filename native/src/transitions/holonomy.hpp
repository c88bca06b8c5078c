// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation of every cut, from the curvature on one side of it.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct NodeKind;
template <typename T>
using PerNode = ArrayPer<NodeKind, T>;

// Cones, junctions and boundary loops as nodes joined by cuts, with a spanning tree rooted where the rest hangs off.
struct NodeGraph {
  PerNode<Index> vertex;      // none for a boundary loop
  PerNode<Index> loop;        // none for a vertex
  PerCut<Index> tail, head;   // nodes
  PerNode<Index> parent_cut;  // the cut toward the root, none at the root
  Array<Index> order;         // nodes from the root outwards
  PerCut<char> in_tree;       // the others close a loop about a handle
};

// root_rank(v): at most 1; the higher, the better a root a vertex makes. Boundary loops are taken before any vertex.
NodeGraph build_node_graph(const HalfedgeMesh& mesh, const CutGraph& cut_graph,
                           const std::function<double(Index)>& root_rank);

// The rotation angle r of every cut, z_right = e^{ir} z_left + t, radians. At every node
//   sum over cuts leaving it of r - sum over cuts arriving of r = -curvature   (mod 2 pi),
// so on a tree r is the curvature of all nodes on the head's side.
// node_curvature: (nodes) imposed, 0 at junctions, total turning of boundary loops.
// free_rotation: (cuts) the rotation of cuts outside the spanning tree, which curvature alone leaves free.
Eigen::VectorXd find_rotations(const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                               const Eigen::VectorXd& free_rotation);

}  // namespace lsgp
