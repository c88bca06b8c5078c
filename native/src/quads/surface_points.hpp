// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a triangulated surface, and the nearest one around a given one.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct SurfacePoint {
  Index triangle;
  Eigen::Vector3d weights;  // of its corners, at least 0, their sum 1
};

class SurfacePoints {
 public:
  // surface: a valid one, which has to outlive it.
  explicit SurfacePoints(const Surface& surface);

  Eigen::Vector3d position(const SurfacePoint& point) const;
  Eigen::Vector3d normal(Index triangle) const;  // of length 1, or 0 where there is none

  // Goes from the triangle of a point to neighbours that are nearer to a target, until there is none.
  SurfacePoint nearest(const SurfacePoint& from, const Eigen::Vector3d& target) const;

 private:
  SurfacePoint nearest_in(Index triangle, const Eigen::Vector3d& target) const;
  Eigen::Vector3d corner(Index triangle, int c) const;

  const Surface& surface_;
  Array<Index> first_, around_;  // the triangles around vertex v: around_[first_[v]] to around_[first_[v + 1]]
};

}  // namespace lsgp
