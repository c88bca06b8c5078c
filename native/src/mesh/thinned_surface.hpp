// SPDX-License-Identifier: GPL-3.0-or-later
// A surface with few of its vertices, and the place of all others on it.
#pragma once

#include "lsgp/surface.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/per_element.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// A point of a triangle: the barycentric shares of its corners, at least 0, of sum 1.
struct SurfacePlace {
  Index triangle = none;
  double share[3] = {0, 0, 0};

  // The corner that the point is at, or none.
  int corner() const { return share[0] == 1 ? 0 : share[1] == 1 ? 1 : share[2] == 1 ? 2 : none; }
};

struct ThinnedSurface {
  Triangles triangles;            // (t, 3) of the surface's own vertices, those that are left
  PerHalfedge<Index> twin;        // of these triangles; none on boundaries, and where the surface is not a manifold
  PerVertex<SurfacePlace> place;  // (n) on these triangles; none of vertices without a triangle
  PerTriangle<Index> kept;        // (m) what each triangle of the surface is among these; none of those that are gone
  // (m) the first triangle of each one's polygon, which no cut runs through; empty if all are triangles
  PerTriangle<Index> polygon;
};

// The vertices that are left, in their order.
struct VerticesLeft {
  PerVertex<Index> number;  // none of those that are gone
  Array<Index> vertex;      // of each number
};
VerticesLeft vertices_left(const ThinnedSurface& thinned);

// Which of the triangles that are left a triangle of the whole surface is, or about where it was.
Index triangle_left(const Triangles& whole, const ThinnedSurface& thinned, Index f);

// Removes vertices in the interior and retriangulates the holes, until about so many triangles are left; more if the
// others cannot be removed.  Boundaries, seams, borders and features stay as they are, and so do vertices and edges
// where the surface is not an oriented manifold.  The places follow flattened rings (Lee et al. 1998), so that the
// surface is mapped one to one.
// edges, twin: of the surface, the latter as of `find_twins`.
ThinnedSurface thin(const Surface& surface, const EdgeTable& edges, const PerHalfedge<Index>& twin, Index triangles);

// The halfedge on the other side of each, or none where an edge has not exactly two triangles, oriented alike.
PerHalfedge<Index> find_twins(const Surface& surface, const EdgeTable& edges);

}  // namespace lsgp
