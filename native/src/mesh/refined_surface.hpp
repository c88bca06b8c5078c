// SPDX-License-Identifier: GPL-3.0-or-later
// A thinned surface that gets single vertices back.
#pragma once

#include <Eigen/Core>
#include <array>

#include "mesh/thinned_surface.hpp"

namespace lsgp {

// Its triangles are those of the thinned surface and, behind them, those around added vertices.
class RefinedSurface {
 public:
  // positions: of the whole surface.  fixed: (3t) edges that stay, on both halfedges.
  RefinedSurface(const ThinnedSurface& thinned, const Positions& positions, const PerHalfedge<char>& fixed);

  // Adds a vertex at its place, joined to about six others, since a cone with few triangles around it cannot have large
  // angles.
  void add(Index vertex, const SurfacePlace& place) { insert(vertex, locate(place)); }

  // The place on the triangles that have replaced one of the thinned surface's.
  SurfacePlace locate(SurfacePlace place) const;

  Index triangle_count() const { return static_cast<Index>(triangles_.size()); }
  Index corner_of(Index f, int corner) const { return triangles_[f][static_cast<std::size_t>(corner)]; }
  const std::array<Index, 3>& triangle(Index f) const { return triangles_[f]; }
  bool is_replaced(Index f) const { return star_of_[f] != none; }
  Index twin(Index h) const { return twin_[h]; }
  Index thinned_at(Index f) const { return thinned_at_[f]; }  // the thinned surface's triangle about where it is

 private:
  using Point = Eigen::Vector2d;

  // The triangles around an added vertex, in the plane with that at 0.
  struct Star {
    Index first;        // triangle; the others follow
    Array<Point> ring;  // the ends of their outer edges
  };
  // An edge around the triangles that are replaced: its first end, and its halfedge inside them.
  struct Outer {
    Index vertex, halfedge;
    Point at;
  };

  void insert(Index vertex, const SurfacePlace& at);
  Point apex_beyond(Index h, const Point& tail, const Point& head) const;
  Index append(Index vertex, Index tail, Index head, Index thinned);
  void link(Index h, Index twin);

  const Positions& positions_;
  PerTriangle<std::array<Index, 3>> triangles_;
  PerHalfedge<Index> twin_;
  PerHalfedge<char> fixed_;
  PerTriangle<Index> star_of_;                 // that replaces it, or none
  PerTriangle<std::array<Point, 3>> in_star_;  // where its corners are in the plane of that
  PerTriangle<Index> thinned_at_;
  Array<Star> stars_;
};

}  // namespace lsgp
