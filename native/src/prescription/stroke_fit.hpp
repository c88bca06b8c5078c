// SPDX-License-Identifier: GPL-3.0-or-later
// How well a map can follow several strokes: the angles between their images as a function of what may be chosen, the
// curvatures of cones or the rotations about handles.
#pragma once

#include <Eigen/Core>

#include "cut/cut_graph.hpp"
#include "prescription/log_scale.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

// Whether directions are strokes on a part of the surface, which the choice of a map may follow; one that is given
// everywhere, such as the model's upward direction, only turns it.
bool are_strokes(const TextureDirections& directions, const Geometry& geometry);

// Strokes that the choice of a map follows.
struct FollowedStrokes {
  const TextureDirections& directions;
  double price;  // of a misfit of 1 radian^2, in the energy of a twist by rotations about handles
};

// The strokes that represent all of them.
struct Strokes {
  Array<Index> triangles;
  Eigen::VectorXd angle;   // in the frame of the triangle, radians
  Eigen::VectorXd weight;  // of sum 1
};
Strokes sample_strokes(const Geometry& geometry, const TextureDirections& directions);

// The mean square of the angles between the images of strokes and what they have in common, modulo a period, with the
// angles affine in some variables x.
class StrokeFit {
 public:
  // angle: of the images at x = 0. effect: (strokes, k) of the variables.
  StrokeFit(Eigen::VectorXd weight, Eigen::VectorXd angle, Eigen::MatrixXd effect, double period);

  double misfit(const Eigen::VectorXd& x) const;  // radians^2

  // The quadratic form that equals the misfit at x and wherever no image is nearer to another multiple of the period.
  LogScale::Variance form_near(const Eigen::VectorXd& x) const;

 private:
  // From the common direction, within half a period.
  Eigen::VectorXd deviations(const Eigen::VectorXd& x) const;

  Eigen::VectorXd weight_, angle_;
  Eigen::MatrixXd effect_;
  double period_;
};

// x: the curvatures of the cones of a log scale.  rotation_order: of the layout's lattice, 0 without one.
StrokeFit fit_of_curvature(const LogScale& scale, const CutGraph& cut_graph, const TextureDirections& directions,
                           int rotation_order);

}  // namespace lsgp
