// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel transport of a map's frames across triangles and cuts: the flat connection that it realizes.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "cut/cut_mesh.hpp"
#include "prescription/curvature.hpp"
#include "prescription/stroke_fit.hpp"
#include "transitions/holonomy.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

struct ParallelTransport {
  Eigen::VectorXd frames;    // (m) rotation of every triangle, radians
  Eigen::VectorXd rotation;  // (cuts) radians
  Reduction reduction;       // positions under these rotations
};

// The connection of the prescribed metric; if a layout admits only certain rotations about handles, those that twist
// the metric's frames least.
class ParallelTransportChoice {
 public:
  // strokes: which rotations about handles follow, as far as their price is worth the twist.
  ParallelTransportChoice(const CutSurface& surface, const Curvature& curvature, int rotation_order,
                          const std::optional<FollowedStrokes>& strokes = std::nullopt);

  // Whether rotations about handles differ from the metric's.
  bool is_twisted() const { return twist_.size() > 0; }
  const Eigen::VectorXd& twist() const { return twist_; }  // (m) the resulting increment of the frames

  // share: of the twist, 1 for the chosen rotations.  curvature: of a metric with the same cones.
  ParallelTransport at(double share, const Curvature& curvature) const;

 private:
  const CutSurface surface_;
  const int rotation_order_;
  Eigen::VectorXd twist_, change_;  // of frames and rotations, empty where none
};

// The target of a map: rotations and frames, angles and scale.
struct MapTarget {
  const ParallelTransport& connection;
  const Curvature& curvature;
};

// The connection that a map without flips realizes: its rotations, and the rotations of its triangles as frames.
ParallelTransport connection_of_map(const CutSurface& surface, const Curvature& curvature,
                                    const Eigen::VectorXd& rotation, const Eigen::VectorXcd& position);

// The imposed curvature of every node: a vertex' own, the sum along a loop.
Eigen::VectorXd curvature_of_nodes(const HalfedgeMesh& mesh, const NodeGraph& nodes, const Eigen::VectorXd& at_vertex);

}  // namespace lsgp
