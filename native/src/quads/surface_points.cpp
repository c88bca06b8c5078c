// SPDX-License-Identifier: GPL-3.0-or-later
#include "quads/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace lsgp {

namespace {

// Steps from triangle to triangle, each of which is nearer.
constexpr int most_steps = 1000;

}  // namespace

SurfacePoints::SurfacePoints(const Surface& surface) : surface_(surface) {
  first_.assign(surface.positions.rows() + 1, 0);
  const Index corners = static_cast<Index>(surface.triangles.size());
  for (Index corner = 0; corner < corners; ++corner) ++first_[surface.triangles.data()[corner] + 1];
  for (Eigen::Index v = 0; v < surface.positions.rows(); ++v) first_[v + 1] += first_[v];
  around_.resize(corners);
  Array<Index> next = first_;
  for (Index corner = 0; corner < corners; ++corner) {
    around_[next[surface.triangles.data()[corner]]++] = corner / 3;
  }
}

Eigen::Vector3d SurfacePoints::corner(Index triangle, int c) const {
  return surface_.positions.row(surface_.triangles(triangle, c));
}

Eigen::Vector3d SurfacePoints::position(const SurfacePoint& point) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) sum += point.weights[c] * corner(point.triangle, c);
  return sum;
}

Eigen::Vector3d SurfacePoints::normal(Index triangle) const {
  const Eigen::Vector3d a = corner(triangle, 0);
  return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
}

SurfacePoint SurfacePoints::nearest_in(Index triangle, const Eigen::Vector3d& target) const {
  const Eigen::Vector3d a = corner(triangle, 0);
  const Eigen::Vector3d ab = corner(triangle, 1) - a, ac = corner(triangle, 2) - a, way = target - a;
  const Eigen::Vector3d up = ab.cross(ac);
  SurfacePoint best{triangle, Eigen::Vector3d(1, 0, 0)};
  const double area = up.squaredNorm();
  if (area > 0) {
    const double b = up.dot(way.cross(ac)) / area, c = up.dot(ab.cross(way)) / area;
    if (b >= 0 && c >= 0 && b + c <= 1) {
      best.weights = {1 - b - c, b, c};
      return best;
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (int tail = 0; tail < 3; ++tail) {
    const int head = (tail + 1) % 3;
    const Eigen::Vector3d side = corner(triangle, head) - corner(triangle, tail);
    const double length = side.squaredNorm();
    const double along = length > 0 ? side.dot(target - corner(triangle, tail)) / length : 0;
    SurfacePoint point{triangle, Eigen::Vector3d::Zero()};
    point.weights[head] = std::clamp(along, 0.0, 1.0);
    point.weights[tail] = 1 - point.weights[head];
    const double distance = (position(point) - target).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = point;
  }
  return best;
}

SurfacePoint SurfacePoints::nearest(const SurfacePoint& from, const Eigen::Vector3d& target) const {
  SurfacePoint best = nearest_in(from.triangle, target);
  double least = (position(best) - target).squaredNorm();
  for (int step = 0; step < most_steps; ++step) {
    const SurfacePoint at = best;
    for (int c = 0; c < 3; ++c) {
      if (at.weights.minCoeff() > 0 || at.weights[c] == 0) continue;
      const Index v = surface_.triangles(at.triangle, c);
      for (Index i = first_[v]; i < first_[v + 1]; ++i) {
        const SurfacePoint point = nearest_in(around_[i], target);
        const double distance = (position(point) - target).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = point;
      }
    }
    if (best.triangle == at.triangle) break;
  }
  return best;
}

}  // namespace lsgp
