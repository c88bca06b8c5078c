// SPDX-License-Identifier: GPL-3.0-or-later
// A map whose features are to run along the axes, and its repair and relaxation under such conditions.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "prescription/curvature.hpp"
#include "repair/newton.hpp"
#include "seamless/lattice_transitions.hpp"

namespace lsgp {

struct FeatureTask {
  CutSurface surface;
  const Curvature& curvature;
  const Eigen::VectorXd& rotation;  // (cuts) radians, multiples of quarter turns
  const LatticeReduction& lattice;
  const Reduction& reduction;  // of the same maps, to the unknowns that are minimized over
  StepHook before_step;

  // The interior vertices with curvature.
  PerVertex<char> mark_cones() const;

  // Positions are of copies.
  bool is_upright(Index triangle, const Eigen::VectorXcd& position) const;
  // A few triangles do not count.
  bool flips_at_most(double share, const Eigen::VectorXcd& position) const;
  bool is_valid(const Eigen::VectorXcd& position) const;
  // The vertices of flipped triangles, and those with wrong angle sums, sorted.
  Array<Index> defects_of(const Eigen::VectorXcd& position) const;

  // Removes flips and relaxes stretch under conditions, unless too much is flipped; whether the map is valid then.
  bool minimize(const DegreesOfFreedom& freedom, Eigen::VectorXcd& position) const;
  // weights: (m) of triangles.
  void relax(const DegreesOfFreedom& freedom, const Eigen::VectorXd& weights, Eigen::VectorXcd& position) const;
};

}  // namespace lsgp
