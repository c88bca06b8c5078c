// SPDX-License-Identifier: GPL-3.0-or-later
// How a map turns from triangle to triangle and across the cuts: the flat connection it realises.
#pragma once

#include <Eigen/Core>

#include "curvature.hpp"
#include "cut_mesh.hpp"
#include "holonomy.hpp"
#include "transitions.hpp"

namespace lsgp {

struct Connection {
  Eigen::VectorXd frames;    // (m) turn of every triangle, radians
  Eigen::VectorXd rotation;  // (cuts) radians
  Reduction reduction;       // positions under these rotations
};

// The connection of the prescribed metric, and where a layout admits only some rotations about handles, those that
// twist the metric's frames least.
class ConnectionChoice {
 public:
  ConnectionChoice(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                   const CutMesh& cut_mesh, const Curvature& curvature, int symmetry);

  // Whether loops about handles turn otherwise than in the metric.
  bool is_twisted() const { return twist_.size() > 0; }
  const Eigen::VectorXd& twist() const { return twist_; }  // (m) what that adds to the frames

  // share: of the twist, 1 for the rotations that were chosen.
  Connection at(double share) const;

 private:
  const HalfedgeMesh& mesh_;
  const CutGraph& cut_graph_;
  const CutMesh& cut_mesh_;
  const int symmetry_;
  NodeGraph nodes_;
  Eigen::VectorXd node_curvature_;
  Eigen::VectorXd frames_, rotation_;  // of the metric
  Eigen::VectorXd twist_, change_;     // of them, empty where none
};

// The imposed curvature of every node: a vertex' own, the sum along a loop.
Eigen::VectorXd curvature_of_nodes(const HalfedgeMesh& mesh, const NodeGraph& nodes, const Eigen::VectorXd& at_vertex);

}  // namespace lsgp
