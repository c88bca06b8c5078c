// SPDX-License-Identifier: GPL-3.0-or-later
// Distances along the surface's edges to the nearest of some vertices.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

class NearestDistance {
 public:
  explicit NearestDistance(const MetricMesh& surface);
  void add(const Array<Index>& vertices);              // visits only what is nearer to them than to those before
  const Eigen::VectorXd& all() const { return far_; }  // (n) infinite where there is none

 private:
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  Eigen::VectorXd far_;
};

}  // namespace lsgp
