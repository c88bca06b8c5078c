// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/visibility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "mesh/per_element.hpp"

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
      : size_(size),
        scale_(size / extent),
        depth_(static_cast<Eigen::Index>(size) * size),
        farthest_(static_cast<Eigen::Index>(size + 1) * (size + 1)) {}

  void look(const Eigen::Vector3d& view, const Eigen::RowVector3d& center) {
    const Eigen::Vector3d right = view.unitOrthogonal();
    axes_ << right, view.cross(right), view;
    center_ = center;
    std::fill(depth_.begin(), depth_.end(), -std::numeric_limits<float>::infinity());
  }

  double pixels(double length) const { return scale_ * length; }

  // Columns and rows of pixels, and depth in pixels, larger towards the viewer.
  Eigen::RowVector3d project(const Eigen::RowVector3d& point) const {
    Eigen::RowVector3d out = scale_ * (point - center_) * axes_;
    out.head<2>().array() += 0.5 * size_;
    return out;
  }

  void draw(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& c) {
    // Most small triangles contain the center of no pixel.
    const int first_row = first_center(std::min(std::min(a[1], b[1]), c[1])),
              last_row = last_center(std::max(std::max(a[1], b[1]), c[1]));
    if (first_row > last_row) return;
    const int first_column = first_center(std::min(std::min(a[0], b[0]), c[0])),
              last_column = last_center(std::max(std::max(a[0], b[0]), c[0]));
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

  // After all triangles: for every corner of pixels the farthest depth of the pixels around it.
  void finish() {
    const Eigen::Index corners = size_ + 1;
    for (Eigen::Index row = 0; row < corners; ++row) {
      const float* above = depth_.data() + std::min<Eigen::Index>(row, size_ - 1) * size_;
      const float* below = depth_.data() + std::max<Eigen::Index>(row - 1, 0) * size_;
      float* out = farthest_.data() + row * corners;
      for (Eigen::Index column = 0; column < size_; ++column) out[column] = std::min(below[column], above[column]);
      out[size_] = out[size_ - 1];
      for (Eigen::Index column = size_ - 1; column > 0; --column) out[column] = std::min(out[column - 1], out[column]);
    }
  }

  // A point is visible if at least one of the four pixels around it shows no surface nearer to the viewer, so that
  // surfaces that are steep in this view do not hide themselves.
  bool shows(const Eigen::RowVector3d& point) const {
    constexpr double slack = 1;  // pixels
    const Eigen::Index column = first_center(point[0]), row = first_center(point[1]);
    return farthest_[row * (size_ + 1) + column] <= point[2] + slack;
  }

 private:
  // std::ceil and std::floor are calls where the processor need not have an instruction for them.
  int first_center(double x) const {
    const double at = std::clamp(x - 0.5, 0.0, static_cast<double>(size_));
    const int whole = static_cast<int>(at);
    return whole + (whole < at);
  }
  int last_center(double x) const {
    const double at = std::clamp(x - 0.5, -1.0, size_ - 1.0);
    const int whole = static_cast<int>(at);
    return whole - (whole > at);
  }

  const int size_;
  const double scale_;
  Eigen::Matrix3d axes_;
  Eigen::RowVector3d center_;
  Array<float> depth_;     // of every pixel
  Array<float> farthest_;  // of every corner of pixels
};

// Pixels of about a triangle's size.
int buffer_size(Eigen::Index triangles) {
  return static_cast<int>(std::clamp(2 * std::sqrt(static_cast<double>(triangles)), 256.0, 768.0));
}

// How often edges are seen: long ones in the middle, those that are hardly longer than a pixel at both ends, which are
// fewer than edges and are projected anyway.
class SeenEdges {
 public:
  SeenEdges(const Positions& positions, const VertexPairs& edges, const DepthBuffer& buffer)
      : positions_(positions),
        edges_(edges),
        is_end_(positions.rows(), 0),
        at_ends_(positions.rows(), 0),
        in_middle_(edges.rows(), 0) {
    constexpr double short_edge = 2;  // pixels
    for (Eigen::Index row = 0; row < edges.rows(); ++row) {
      const Index a = edges(row, 0), b = edges(row, 1);
      if (buffer.pixels((positions.row(a) - positions.row(b)).norm()) > short_edge) {
        long_.push_back(row);
      } else {
        is_end_[a] = is_end_[b] = 1;
      }
    }
  }

  void look(const DepthBuffer& buffer, const Positions& projected) {
    for (Eigen::Index v = 0; v < projected.rows(); ++v) {
      if (is_end_[v]) at_ends_[v] += buffer.shows(projected.row(v));
    }
    for (const Eigen::Index row : long_) {
      const Eigen::RowVector3d middle = (positions_.row(edges_(row, 0)) + positions_.row(edges_(row, 1))) / 2;
      in_middle_[row] += buffer.shows(buffer.project(middle));
    }
  }

  Eigen::VectorXd shares() const {
    Eigen::VectorXd out(edges_.rows());
    for (Eigen::Index row = 0; row < out.size(); ++row) {
      out[row] = (at_ends_[edges_(row, 0)] + at_ends_[edges_(row, 1)]) / (2.0 * view_count);
    }
    for (const Eigen::Index row : long_) out[row] = in_middle_[row] / static_cast<double>(view_count);
    return out;
  }

 private:
  const Positions& positions_;
  const VertexPairs& edges_;
  PerVertex<char> is_end_;  // of a short edge
  PerVertex<int> at_ends_;
  Array<int> in_middle_;
  Array<Eigen::Index> long_;
};

}  // namespace

Eigen::VectorXd visible_share(const Surface& surface, const VertexPairs& edges, const Eigen::Vector3d& front) {
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
  SeenEdges seen(surface.positions, edges, buffer);
  for (const Eigen::Vector3d& view : views_around(front.stableNormalized())) {
    buffer.look(view, (low + high) / 2);
    for (Eigen::Index v = 0; v < projected.rows(); ++v) projected.row(v) = buffer.project(surface.positions.row(v));
    for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f) {
      checkpoint(operations_a_triangle);
      buffer.draw(projected.row(surface.triangles(f, 0)), projected.row(surface.triangles(f, 1)),
                  projected.row(surface.triangles(f, 2)));
    }
    buffer.finish();
    seen.look(buffer, projected);
  }
  return seen.shares();
}

}  // namespace lsgp
