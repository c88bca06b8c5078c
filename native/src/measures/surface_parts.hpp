// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of maps on each connected component of their surface, by which maps are compared piece by piece.
#pragma once

#include <vector>

#include "base/borrowed.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

// The connected components of a surface in the order of their first triangles, and which triangles are at a vertex.
class SurfaceParts {
 public:
  // Throws what `parameterize` throws for invalid surfaces.
  explicit SurfaceParts(Borrowed<const Surface> surface);

  const Surface& surface() const { return surface_; }
  Index count() const { return static_cast<Index>(areas_.size()); }
  // none for triangles that are left out.
  const PerTriangle<Index>& of_triangle() const { return of_triangle_; }
  // One of those that a vertex belongs to, inside if it is inside of some, or none.
  const PerVertex<Index>& of_vertex() const { return of_vertex_; }
  const PerComponent<double>& areas() const { return areas_; }
  double area() const { return area_; }  // of all
  // Whether each is a disk without vertices inside, such as a fin of a few triangles: whatever is chosen, it unfolds
  // without cones, cuts and stretch.
  const PerComponent<char>& are_plain() const { return are_plain_; }
  // (m) of each triangle.
  const PerTriangle<double>& triangle_areas() const { return triangle_areas_; }

  // The first triangle at an edge; none without any.
  Index triangle_at(Index a, Index b) const;
  // Calls visit(corner) for every side from that corner to the next which is this edge.
  template <typename Visit>
  void for_each_side(Index a, Index b, Visit visit) const;

 private:
  const Surface& surface_;
  PerTriangle<Index> of_triangle_;
  PerVertex<Index> of_vertex_;
  PerTriangle<double> triangle_areas_;
  PerComponent<double> areas_;
  PerComponent<char> are_plain_;
  double area_ = 0;
  Array<Index> first_corner_, corners_;  // of a vertex those from its first one up to that of the next
};

double length_of(const Surface& surface, const VertexPairs& edges);

// The total length of those edges of the surface that each component has.
PerComponent<double> lengths_on(const SurfaceParts& parts, const VertexPairs& edges);

// (c) what cuts cost beyond their length: the surface's costs above 1, relative to those of cheap edges where these
// are above 1 as well.
PerComponent<double> extra_costs_on(const SurfaceParts& parts, const VertexPairs& cuts);

// Whether each has some of these edges.
PerComponent<char> have_edges(const SurfaceParts& parts, const VertexPairs& edges);

// How many of the vertices, triangles, islands and defects each component has.
PerComponent<Index> counts_on(const SurfaceParts& parts, const std::vector<Index>& vertices);
PerComponent<Index> triangles_on(const SurfaceParts& parts);
PerComponent<Index> solved_on(const SurfaceParts& parts, const Result& result);
PerComponent<Index> islands_on(const SurfaceParts& parts, const Result& result);
PerComponent<Index> defects_on(const SurfaceParts& parts, const Result& result);

// The L2 stretch of each, at a scale of its own; NaN where one is not solved.
PerComponent<double> stretches_on(const SurfaceParts& parts, const Result& result);

// What each adds to the excess of the L2 stretch over 1; infinite where one is not solved.
PerComponent<double> excess_on(const SurfaceParts& parts, const Result& result);

template <typename Visit>
void SurfaceParts::for_each_side(Index a, Index b, Visit visit) const {
  for (Index i = first_corner_[a]; i < first_corner_[a + 1]; ++i) {
    const Index corner = corners_[i], f = corner / 3;
    for (Index side = 3 * f; side < 3 * f + 3; ++side) {
      const Index next = side % 3 == 2 ? side - 2 : side + 1;
      const Index from = surface_.triangles.data()[side], to = surface_.triangles.data()[next];
      if ((from == a && to == b) || (from == b && to == a)) visit(side);
    }
  }
}

}  // namespace lsgp
