// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "plane/aabb_tree.hpp"
#include "plane/boundary_polygon.hpp"
#include "plane/predicates.hpp"
#include "plane/winding_raster.hpp"

namespace lsgp {

namespace {

constexpr double explained_share = 1e-9;   // of a triangle's area that rounding of the map may put on another
constexpr double operations_a_pair = 100;  // of triangles
constexpr double last_digit = std::numeric_limits<double>::epsilon();
constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();
constexpr double explained_digits = 64 * last_digit;  // of a coordinate

double length(Complex a) { return std::sqrt(std::norm(a)); }

using Corners = std::array<Complex, 3>;  // counter-clockwise

// Whether a line along a side of `a` has all of `b` on its far side.
bool is_parted_by_side(const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Complex from = a[i], to = a[(i + 1) % 3];
    if (side(from, to, b[0]) <= 0 && side(from, to, b[1]) <= 0 && side(from, to, b[2]) <= 0) return true;
  }
  return false;
}

// Clips `b` against `a`, side by side (Sutherland and Hodgman 1974); corners relative to one of them.
double shared_area(const Corners& a, const Corners& b) {
  constexpr std::size_t most = 6;
  std::array<Complex, most> one, other;
  std::array<double, most + 1> height;
  Complex *polygon = one.data(), *cut = other.data();
  std::size_t count = 3;
  std::copy(b.begin(), b.end(), polygon);
  for (std::size_t i = 0; i < 3; ++i) {
    const Complex from = a[i], along = a[(i + 1) % 3] - from;
    bool all_inside = true;
    for (std::size_t k = 0; k < count; ++k) {
      height[k] = cross(along, polygon[k] - from);
      all_inside = all_inside && height[k] >= 0;
    }
    if (all_inside) continue;
    height[count] = height[0];
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double here = height[k], there = height[k + 1];
      if (here >= 0 && kept < most) cut[kept++] = polygon[k];
      if ((here < 0) != (there < 0) && here != 0 && there != 0 && kept < most) {
        cut[kept++] = polygon[k] + (polygon[k + 1 < count ? k + 1 : 0] - polygon[k]) * (here / (here - there));
      }
    }
    std::swap(polygon, cut);
    count = kept;
  }
  double doubled = 0;
  for (std::size_t k = 1; k + 1 < count; ++k) doubled += doubled_area(polygon[0], polygon[k], polygon[k + 1]);
  return doubled / 2;
}

Box box_of(const Corners& corners) {
  const auto [left, right] = std::minmax({corners[0].real(), corners[1].real(), corners[2].real()});
  const auto [bottom, top] = std::minmax({corners[0].imag(), corners[1].imag(), corners[2].imag()});
  return {left, right, bottom, top};
}

// Triangles of a layout that have an area.
class Layout {
 public:
  // may_overlap(box): whether to look at a triangle in such a box.
  template <typename MayOverlap>
  Layout(const Eigen::VectorXcd& position, MayOverlap may_overlap) {
    for (Index f = 0; f < static_cast<Index>(position.size() / 3); ++f) {
      Corners corners{position[3 * f], position[3 * f + 1], position[3 * f + 2]};
      const double area = doubled_area(corners[0], corners[1], corners[2]) / 2;
      const Box box = box_of(corners);
      if (!std::isfinite(area) || area == 0 || !may_overlap(box)) continue;
      if (area < 0) std::swap(corners[1], corners[2]);
      triangle_.push_back(f);
      corners_.push_back(corners);
      area_.push_back(std::abs(area));
      boxes_.push_back(box);
    }
  }

  // Those of different faces, or all if there are none; nothing if there are more than so many.
  std::optional<Array<Overlap>> find_overlaps(std::size_t most, const PerTriangle<Index>& face) const {
    Array<Overlap> out;
    const bool are_more = AabbTree(boxes_).any_meeting_pair([&](Index i, Index j) {
      checkpoint(operations_a_pair);
      if (!face.empty() && face[triangle_[i]] == face[triangle_[j]]) return false;
      const double area = overlap(i, j);
      if (!(area > 0)) return false;
      if (out.size() == most) return true;
      // A collapsed layout can have quadratically many pairs.
      if (out.size() == out.capacity()) require_memory(2.0 * static_cast<double>(out.size() * sizeof(Overlap)));
      out.push_back({triangle_[i], triangle_[j], area});
      return false;
    });
    if (are_more) return std::nullopt;
    std::sort(out.begin(), out.end(), [](const Overlap& a, const Overlap& b) {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return out;
  }

 private:
  // 0 where it is none.
  double overlap(Index i, Index j) const {
    const Corners &a = corners_[i], &b = corners_[j];
    if (is_parted_by_side(a, b) || is_parted_by_side(b, a)) return 0;
    const Complex origin = a[0];
    const double area = shared_area({0.0, a[1] - origin, a[2] - origin}, {b[0] - origin, b[1] - origin, b[2] - origin});
    const Index smaller = area_[i] <= area_[j] ? i : j;
    const Corners& c = corners_[smaller];
    const double border = length(c[1] - c[0]) + length(c[2] - c[1]) + length(c[0] - c[2]);
    const Box both = around(boxes_[i], boxes_[j]);
    const double farthest = std::max({-both.left, both.right, -both.bottom, both.top});
    return area > explained_share * area_[smaller] + explained_digits * farthest * border ? area : 0;
  }

  Array<Index> triangle_;
  Array<Corners> corners_;
  Array<double> area_;
  Array<Box> boxes_;
};

Box frame_of(const Eigen::VectorXcd& position) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box frame{infinity, -infinity, infinity, -infinity};
  for (const Complex z : position) {
    if (std::isfinite(z.real()) && std::isfinite(z.imag())) {
      frame = around(frame, {z.real(), z.real(), z.imag(), z.imag()});
    }
  }
  return frame;
}

}  // namespace

Array<Overlap> find_overlaps(const Eigen::VectorXcd& position) {
  return *Layout(position, [](const Box&) { return true; }).find_overlaps(any_number, {});
}

Array<Overlap> find_overlaps(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin) {
  return *find_few_overlaps(position, twin, any_number, {});
}

std::optional<Array<Overlap>> find_few_overlaps(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin,
                                                std::size_t most, const PerTriangle<Index>& face) {
  const BoundaryPolygon boundary(position, twin);
  if (!boundary.has_overlap()) return Array<Overlap>();
  const WindingRaster twice(boundary, frame_of(position), static_cast<Index>(twin.size() / 3));
  return Layout(position, [&](const Box& box) { return twice.meets(box); }).find_overlaps(most, face);
}

bool has_overlap(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin) {
  return BoundaryPolygon(position, twin).has_overlap();
}

}  // namespace lsgp
