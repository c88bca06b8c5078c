// SPDX-License-Identifier: GPL-3.0-or-later
// A thinned surface that gets single vertices back.
#pragma once

#include <array>

#include "mesh/thinned_surface.hpp"

namespace lsgp {

// Its triangles are those of the thinned surface and, behind them, the parts into which added vertices divide them.
class RefinedSurface {
 public:
  // fixed: (3t) edges that stay whole, on both halfedges.
  RefinedSurface(const ThinnedSurface& thinned, const PerHalfedge<char>& fixed);

  // Adds a vertex at its place unless a corner near it does as well.  may_be: whether a vertex does.  Returns the
  // vertex that is there.
  template <typename Predicate>
  Index add(Index vertex, const SurfacePlace& place, const Predicate& may_be) {
    const SurfacePlace at = locate(place);
    for (int c = 0; c < 3; ++c) {
      const Index corner = triangles_[at.triangle][static_cast<std::size_t>(c)];
      if (at.share[c] > share_at_corner && may_be(corner)) return corner;
    }
    insert(vertex, at);
    return vertex;
  }

  // The place on the parts of one of the thinned surface's triangles.
  SurfacePlace locate(SurfacePlace place) const;

  Index triangle_count() const { return static_cast<Index>(triangles_.size()); }
  const std::array<Index, 3>& triangle(Index f) const { return triangles_[f]; }
  bool is_divided(Index f) const { return part_[f].size > 0; }
  Index twin(Index h) const { return twin_[h]; }
  Index whole(Index f) const { return whole_[f]; }  // the thinned surface's triangle that it is a part of

 private:
  static constexpr double share_at_corner = 0.8;

  // The parts have the added vertex in place of one corner each.
  struct Parts {
    int size = 0;
    double share[3];  // of the added vertex
    Index with_corner_replaced[3];
  };

  void insert(Index vertex, const SurfacePlace& at);
  Index append(Index f, int corner, Index vertex);
  void link(Index h, Index twin);
  void divide(Index f, int opposite, Index vertex, double at_first);

  PerTriangle<std::array<Index, 3>> triangles_;
  PerHalfedge<Index> twin_;
  PerHalfedge<char> fixed_;
  PerTriangle<Parts> part_;
  PerTriangle<Index> whole_;
};

}  // namespace lsgp
