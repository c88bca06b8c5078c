// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refined_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

constexpr double least_share_of_corner = 0.05;  // of each where a vertex is added; slivers map badly
constexpr double least_star_shape = 0.02;       // doubled area relative to the squared sides

// Of the triangle of 0 and two points.
double star_shape(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return cross_product(a, b) / (a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm());
}

}  // namespace

RefinedSurface::RefinedSurface(const ThinnedSurface& thinned, const Positions& positions,
                               const PerHalfedge<char>& fixed)
    : positions_(positions),
      twin_(thinned.twin),
      fixed_(fixed),
      star_of_(thinned.triangles.rows(), none),
      in_star_(thinned.triangles.rows()) {
  for (Index f = 0; f < thinned.triangles.rows(); ++f) {
    triangles_.push_back({thinned.triangles(f, 0), thinned.triangles(f, 1), thinned.triangles(f, 2)});
    thinned_at_.push_back(f);
  }
}

SurfacePlace RefinedSurface::locate(SurfacePlace place) const {
  while (is_replaced(place.triangle)) {
    const auto& corner = in_star_[place.triangle];
    const Point at = place.share[0] * corner[0] + place.share[1] * corner[1] + place.share[2] * corner[2];
    const Star& star = stars_[star_of_[place.triangle]];
    double inside = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < star.ring.size(); ++i) {
      const Point &tail = star.ring[i], &head = star.ring[(i + 1) % star.ring.size()];
      const double whole = cross_product(tail, head);
      const double of_tail = cross_product(at, head) / whole, of_head = cross_product(tail, at) / whole;
      const double least = std::min({of_tail, of_head, 1 - of_tail - of_head});
      if (!(least > inside)) continue;
      inside = least;
      place = {star.first + static_cast<Index>(i), {1 - of_tail - of_head, of_tail, of_head}};
    }
    double sum = 0;
    for (double& share : place.share) sum += share = std::max(share, 0.0);
    for (double& share : place.share) share /= sum;
  }
  return place;
}

void RefinedSurface::link(Index h, Index twin) {
  twin_[h] = twin;
  if (twin != none) twin_[twin] = h;
}

Index RefinedSurface::append(Index vertex, Index tail, Index head, Index thinned) {
  triangles_.push_back({vertex, tail, head});
  twin_.resize(twin_.size() + 3, none);
  fixed_.resize(fixed_.size() + 3, 0);
  star_of_.push_back(none);
  in_star_.emplace_back();
  thinned_at_.push_back(thinned);
  return triangle_count() - 1;
}

// The third corner of a halfedge's triangle, on the right of a line in the plane that is its edge.
Eigen::Vector2d RefinedSurface::apex_beyond(Index h, const Point& tail, const Point& head) const {
  const auto position = [&](Index corner) -> Eigen::Vector3d {
    return positions_.row(corner_of(corner / 3, corner % 3)).transpose();
  };
  const Eigen::Vector3d edge = position(next(h)) - position(h), side = position(prev(h)) - position(h);
  const double squared = edge.squaredNorm();
  const double along = edge.dot(side) / squared;
  const double across = std::sqrt(std::max(side.squaredNorm() / squared - along * along, 0.0));
  const Point line = head - tail;
  return tail + along * line + across * Point(-line.y(), line.x());
}

void RefinedSurface::insert(Index vertex, const SurfacePlace& at) {
  const Index f = at.triangle;
  double share[3], sum = 0;
  for (int c = 0; c < 3; ++c) sum += share[c] = std::max(at.share[c], least_share_of_corner);
  const double length = (positions_.row(corner_of(f, 1)) - positions_.row(corner_of(f, 0))).norm();
  std::array<Point, 3> corner{Point(0, 0), Point(length, 0), Point(0, 0)};
  corner[2] = apex_beyond(3 * f, corner[0], corner[1]);
  const Point origin = (share[0] * corner[0] + share[1] * corner[1] + share[2] * corner[2]) / sum;
  for (Point& point : corner) point -= origin;

  Star star{triangle_count(), {}};
  Array<Outer> outer;
  const auto replace = [&](Index triangle, int first, const Point& a, const Point& b, const Point& c) {
    star_of_[triangle] = static_cast<Index>(stars_.size());
    in_star_[triangle][static_cast<std::size_t>(first)] = a;
    in_star_[triangle][static_cast<std::size_t>((first + 1) % 3)] = b;
    in_star_[triangle][static_cast<std::size_t>((first + 2) % 3)] = c;
  };
  replace(f, 0, corner[0], corner[1], corner[2]);
  Array<Index> apexes{corner_of(f, 0), corner_of(f, 1), corner_of(f, 2)};
  for (int c = 0; c < 3; ++c) {
    const Index h = 3 * f + c, twin = twin_[h];
    const Point &tail = corner[static_cast<std::size_t>(c)], &head = corner[static_cast<std::size_t>((c + 1) % 3)];
    outer.push_back({corner_of(f, c), h, tail});
    if (twin == none || fixed_[h]) continue;
    // With the triangle beyond the edge, where that leaves good ones.
    const Index beyond = corner_of(twin / 3, prev(twin) % 3);
    const Point apex = apex_beyond(twin, head, tail);
    const bool is_new = std::find(apexes.begin(), apexes.end(), beyond) == apexes.end();
    if (!is_new || star_shape(tail, apex) < least_star_shape || star_shape(apex, head) < least_star_shape) continue;
    apexes.push_back(beyond);
    replace(twin / 3, static_cast<int>(twin % 3), head, tail, apex);
    outer.back().halfedge = next(twin);
    outer.push_back({beyond, prev(twin), apex});
  }
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Index tail = outer[i].vertex, head = outer[(i + 1) % outer.size()].vertex;
    const Index part = append(vertex, tail, head, thinned_at_[f]);
    fixed_[3 * part + 1] = fixed_[outer[i].halfedge];
    link(3 * part + 1, twin_[outer[i].halfedge]);
    star.ring.push_back(outer[i].at);
  }
  const auto count = static_cast<Index>(outer.size());
  for (Index i = 0; i < count; ++i) link(3 * (star.first + i) + 2, 3 * (star.first + (i + 1) % count));
  stars_.push_back(std::move(star));
}

}  // namespace lsgp
