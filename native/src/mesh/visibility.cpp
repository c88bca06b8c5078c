// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/visibility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr int view_count = 16;

// Directions with cosine density about an axis: uniform points on the disk below (Vogel's spiral).
Array<Eigen::Vector3d> views_around(const Eigen::Vector3d& axis) {
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  const Eigen::Vector3d right = axis.unitOrthogonal(), up = axis.cross(right);
  Array<Eigen::Vector3d> out;
  for (int i = 0; i < view_count; ++i) {
    const double radius = std::sqrt((i + 0.5) / view_count), turn = golden_angle * i;
    out.push_back(radius * (std::cos(turn) * right + std::sin(turn) * up) + std::sqrt(1 - radius * radius) * axis);
  }
  return out;
}

// The surface seen along one direction: for every pixel the depth nearest to the viewer.
class DepthBuffer {
 public:
  DepthBuffer(int size, double extent)
      : size_(size), scale_(size / extent), depth_(static_cast<Eigen::Index>(size) * size) {}

  void look(const Eigen::Vector3d& view, const Eigen::RowVector3d& center) {
    const Eigen::Vector3d right = view.unitOrthogonal();
    axes_ << right, view.cross(right), view;
    center_ = center;
    std::fill(depth_.begin(), depth_.end(), -std::numeric_limits<float>::infinity());
  }

  // Columns and rows of pixels, and depth in pixels, larger toward the viewer.
  Eigen::RowVector3d project(const Eigen::RowVector3d& point) const {
    Eigen::RowVector3d out = scale_ * (point - center_) * axes_;
    out.head<2>().array() += 0.5 * size_;
    return out;
  }

  void draw(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& c) {
    const int first_column = first_center(std::min({a[0], b[0], c[0]}));
    const int last_column = last_center(std::max({a[0], b[0], c[0]}));
    if (first_column > last_column) return;  // most triangles of a large surface lie between pixels
    const int first_row = first_center(std::min({a[1], b[1], c[1]}));
    const int last_row = last_center(std::max({a[1], b[1], c[1]}));
    if (first_row > last_row) return;
    const Eigen::RowVector3d ab = b - a, ac = c - a;
    const double doubled_area = ab[0] * ac[1] - ab[1] * ac[0];
    if (doubled_area == 0) return;
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        const double x = column + 0.5 - a[0], y = row + 0.5 - a[1];
        const double s = (x * ac[1] - y * ac[0]) / doubled_area, t = (ab[0] * y - ab[1] * x) / doubled_area;
        if (s < 0 || t < 0 || s + t > 1) continue;
        float& nearest = depth_[static_cast<Eigen::Index>(row) * size_ + column];
        nearest = std::max(nearest, static_cast<float>(a[2] + s * ab[2] + t * ac[2]));
      }
    }
  }

  // A point is visible if at least one of the four pixels around it shows no surface nearer to the viewer, so that
  // surfaces that are steep in this view do not hide themselves.
  bool shows(const Eigen::RowVector3d& point) const {
    constexpr double slack = 1;  // pixels
    const int column = first_center(point[0]) - 1, row = first_center(point[1]) - 1;
    for (int r = std::max(row, 0); r <= std::min(row + 1, size_ - 1); ++r) {
      for (int c = std::max(column, 0); c <= std::min(column + 1, size_ - 1); ++c) {
        if (depth_[static_cast<Eigen::Index>(r) * size_ + c] <= point[2] + slack) return true;
      }
    }
    return false;
  }

 private:
  // Pixels from and up to a coordinate. Rounding by conversion, since `ceil` and `floor` are calls on older processors.
  int first_center(double x) const {
    const int pixel = static_cast<int>(x - 0.5);
    return std::clamp(pixel + (pixel < x - 0.5), 0, size_);
  }
  int last_center(double x) const {
    const int pixel = static_cast<int>(x - 0.5);
    return std::clamp(pixel - (pixel > x - 0.5), -1, size_ - 1);
  }

  const int size_;
  const double scale_;
  Eigen::Matrix3d axes_;
  Eigen::RowVector3d center_;
  Array<float> depth_;
};

// Pixels of about a triangle's size.
int buffer_size(Eigen::Index triangles) {
  return static_cast<int>(std::clamp(2 * std::sqrt(static_cast<double>(triangles)), 256.0, 768.0));
}

}  // namespace

Eigen::VectorXd visible_share(const Surface& surface, const Positions& points, const Eigen::Vector3d& front) {
  constexpr double operations_a_triangle = 50;
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Eigen::Index corner = 0; corner < surface.triangles.size(); ++corner) {
    const auto position = surface.positions.row(surface.triangles.data()[corner]);
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const double diameter = (high - low).norm();
  DepthBuffer buffer(buffer_size(surface.triangles.rows()), diameter > 0 ? diameter : 1);
  Positions projected(surface.positions.rows(), 3);
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(points.rows());
  for (const Eigen::Vector3d& view : views_around(front.stableNormalized())) {
    buffer.look(view, (low + high) / 2);
    for (Eigen::Index v = 0; v < projected.rows(); ++v) projected.row(v) = buffer.project(surface.positions.row(v));
    for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f) {
      checkpoint(operations_a_triangle);
      buffer.draw(projected.row(surface.triangles(f, 0)), projected.row(surface.triangles(f, 1)),
                  projected.row(surface.triangles(f, 2)));
    }
    for (Eigen::Index p = 0; p < points.rows(); ++p) seen[p] += buffer.shows(buffer.project(points.row(p)));
  }
  return seen / view_count;
}

}  // namespace lsgp
