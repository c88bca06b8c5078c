// SPDX-License-Identifier: GPL-3.0-or-later
// The Green's functions of many cones on a coarse surface: what Newton's method needs of them, at a small part of the
// cost.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/border.hpp"
#include "mesh/coarse_surface.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

class CoarseGreen {
 public:
  // Whether that is cheaper for so many cones than their functions on the surface itself.
  static bool pays(const HalfedgeMesh& mesh, const Array<Index>& cones);

  // border: y is held at one vertex at least, which is on a boundary or a cone.
  CoarseGreen(const MetricMesh& surface, const BorderConditions& border, const Array<Index>& cones);

  const Eigen::MatrixXd& columns() const { return columns_; }                                     // (nodes, k) G_c
  Eigen::MatrixXd at_cones() const { return columns_(nodes_, Eigen::seqN(0, columns_.cols())); }  // (k, k)
  // The sum of values at vertices (n) to each node.
  Eigen::VectorXd at_nodes(const Eigen::VectorXd& values) const { return surface_.at_nodes(values); }

 private:
  CoarseSurface surface_;
  Array<Index> nodes_;  // of the cones
  Eigen::MatrixXd columns_;
};

}  // namespace lsgp
