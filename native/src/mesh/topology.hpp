// SPDX-License-Identifier: GPL-3.0-or-later
// Halfedges, boundary loops and components.
//
// A halfedge is 3 * triangle + corner: it leaves that corner's vertex, runs to the next corner and has its triangle
// on its left. The same number names the corner it leaves.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/surface.hpp"
#include "mesh/per_element.hpp"

namespace lsgp {

constexpr Index none = -1;

inline Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

// A connected, oriented manifold surface in its own numbering.
struct HalfedgeMesh {
  Positions positions;                   // (n, 3)
  Eigen::VectorXd scale;                 // (n) factor of lengths in the metric, or empty: 1
  Triangles triangles;                   // (m, 3)
  PerHalfedge<Index> twin;               // none on the boundary
  PerVertex<Index> outgoing;             // a halfedge leaving each vertex; on the boundary the one without a twin
  PerHalfedge<char> cuttable, seam;      // equal on both halfedges of an edge
  PerHalfedge<char> feature;             // marked to run along an axis, on both halfedges, or empty: none
  PerVertex<char> is_feature_junction;   // of three or more marked edges, borders' other sides included; empty: none
  PerHalfedge<double> cut_factor;        // cost per length of a cut along the edge, or empty: 1
  PerLoop<Array<Index>> boundary_loops;  // vertices, surface on the left
  PerVertex<Index> loop_of_vertex;       // none inside
  int euler = 0;                         // V - E + F
  int genus = 0;

  Index vertex_count() const { return static_cast<Index>(outgoing.size()); }
  Index triangle_count() const { return static_cast<Index>(triangles.rows()); }
  Index halfedge_count() const { return 3 * triangle_count(); }
  Index origin(Index h) const { return triangles.data()[h]; }
  Index target(Index h) const { return triangles.data()[next(h)]; }
  bool closed() const { return boundary_loops.empty(); }
  bool is_disk() const { return genus == 0 && boundary_loops.size() == 1; }
  bool is_ring() const { return genus == 0 && boundary_loops.size() == 2; }
  bool is_torus() const { return genus == 1 && boundary_loops.empty(); }
  bool has_features() const { return !feature.empty(); }

  // The angle of a vertex without curvature: 2 pi in the interior, pi on the boundary.
  double flat_angle(Index v) const { return loop_of_vertex[v] == none ? 2 * M_PI : M_PI; }

  // The next outgoing halfedge counter-clockwise about the same vertex; none after the last at a boundary.
  Index rotate(Index h) const { return twin[prev(h)]; }

  // Calls visit(h) for the halfedges leaving v, counter-clockwise from outgoing[v].
  template <typename Visit>
  void for_each_outgoing(Index v, Visit visit) const {
    Index h = outgoing[v];
    do {
      visit(h);
      h = rotate(h);
    } while (h != none && h != outgoing[v]);
  }
};

// Numbers the parts into which open edges, marked on both halfedges, divide the triangles. Returns their number.
Index label_parts(const HalfedgeMesh& mesh, const PerHalfedge<char>& open, PerTriangle<Index>& part);

// One component of the caller's surface.
struct Component {
  HalfedgeMesh mesh;
  PerVertex<Index> source_vertex;      // the caller's
  PerTriangle<Index> source_triangle;  // the caller's
  PerTriangle<char> reversed;          // corners 1 and 2 exchanged to orient the component
  bool orientable = true;              // otherwise the mesh is empty except for its sources

  // The caller's corner 3 * triangle + corner of one of this component's.
  Index source_corner(Index corner) const {
    const Index f = corner / 3, c = corner % 3;
    return 3 * source_triangle[f] + (reversed[f] && c > 0 ? 3 - c : c);
  }
};

// Whether a triangle names a vertex twice, as it does once the ends of an edge without length are one vertex.
inline bool is_collapsed(const Triangles& triangles, Index f) {
  const Index a = triangles(f, 0), b = triangles(f, 1), c = triangles(f, 2);
  return a == b || b == c || c == a;
}

struct Topology {
  PerComponent<Component> components;
  // Triangles in no component, and the one whose map each shares: the first with the same three vertices or, for one
  // that is collapsed, with the same edge.
  Array<std::pair<Index, Index>> duplicates;
  Array<Index> collapsed;  // triangles in no component, duplicates among them
};

// Which seams are boundaries: those of the marked triangles; empty: none.
using OpenSeams = PerTriangle<char>;

// Splits a surface into components joined along edges of two triangles and, at edges of more, along those pairs of
// triangles that continue each other. Vertices whose triangles form several fans are split, triangles oriented against
// their component's majority are reversed, duplicate triangles are left out; each is reported. Collapsed triangles are
// left out and listed.
// Throws EDGE_NOT_IN_MESH, SEAM_NOT_AN_EDGE.
Topology build_topology(const Surface& surface, const OpenSeams& open_seams, std::vector<Finding>& findings);

}  // namespace lsgp
