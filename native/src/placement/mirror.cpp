// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "base/array.hpp"
#include "placement/cone_sites.hpp"

namespace lsgp {

namespace {

constexpr double tolerance = 0.1;       // mean edge lengths between a vertex and the image of another
constexpr double least_matched = 0.98;  // of the vertices of a symmetric surface

// Points in the cells of a grid.
class PointGrid {
 public:
  PointGrid(const Positions& points, double cell) : points_(points), cell_(cell) {
    for (Index v = 0; v < points.rows(); ++v) cells_[key(cell_of(points.row(v)))].push_back(v);
  }

  // The nearest point within a cell's side, or none.
  Index nearest(const Eigen::RowVector3d& at) const {
    if (!at.allFinite()) return none;  // the mirror plane is too far away
    const std::array<std::int64_t, 3> center = cell_of(at);
    Index best = none;
    double least = cell_;
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find(key({center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const Index v : found->second) {
        const double distance = (points_.row(v) - at).norm();
        if (!(distance < least)) continue;
        least = distance;
        best = v;
      }
    }
    return best;
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Eigen::RowVector3d& at) const {
    constexpr double most = 1e15;
    const auto step = [&](double x) {
      return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_), -most, most));
    };
    return {step(at[0]), step(at[1]), step(at[2])};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15u;
    return hash;
  }

  const Positions& points_;
  double cell_;
  std::unordered_map<std::uint64_t, Array<Index>> cells_;
};

Array<MirrorPlane> likely_planes(const HalfedgeMesh& mesh, const Geometry& geometry) {
  const Eigen::RowVector3d center = geometry.vertex_area.transpose() * mesh.positions / geometry.total_area;
  const Positions centered = mesh.positions.rowwise() - center;
  const Eigen::Matrix3d spread = centered.transpose() * geometry.vertex_area.asDiagonal() * centered;
  const Eigen::Matrix3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  Array<MirrorPlane> planes;
  for (int i = 0; i < 3; ++i) planes.push_back({center.transpose(), Eigen::Vector3d::Unit(i)});
  for (int i = 0; i < 3; ++i) planes.push_back({center.transpose(), principal.col(i)});
  return planes;
}

Array<Index> images_in(const MirrorPlane& plane, const HalfedgeMesh& mesh, const PointGrid& grid) {
  const Eigen::RowVector3d normal = plane.normal.stableNormalized().transpose(), point = plane.point.transpose();
  Array<Index> image(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::RowVector3d at = mesh.positions.row(v);
    image[v] = grid.nearest(at - 2 * (at - point).dot(normal) * normal);
  }
  Array<Index> mutual = image;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const bool both = image[v] != none && image[image[v]] == v;
    const bool alike = both && (mesh.loop_of_vertex[v] == none) == (mesh.loop_of_vertex[image[v]] == none);
    if (!alike) mutual[v] = none;
  }
  return mutual;
}

}  // namespace

Array<Index> find_mirror_images(const HalfedgeMesh& mesh, const Geometry& geometry,
                                const std::optional<MirrorPlane>& plane) {
  const PointGrid grid(mesh.positions, tolerance * geometry.length.mean());
  const Array<MirrorPlane> planes = plane ? Array<MirrorPlane>{*plane} : likely_planes(mesh, geometry);
  Array<Index> best;
  std::ptrdiff_t most = static_cast<std::ptrdiff_t>(std::ceil(least_matched * mesh.vertex_count())) - 1;
  for (const MirrorPlane& tried : planes) {
    Array<Index> images = images_in(tried, mesh, grid);
    const std::ptrdiff_t matched = mesh.vertex_count() - std::count(images.begin(), images.end(), none);
    if (matched <= most) continue;
    most = matched;
    best = std::move(images);
  }
  return best;
}

}  // namespace lsgp
