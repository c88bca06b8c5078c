// SPDX-License-Identifier: GPL-3.0-or-later
// The intrinsic geometry of a surface: lengths, angles, areas, cotangent weights, angle defects.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct Geometry {
  Eigen::VectorXd length;          // (3m) of halfedges
  Eigen::VectorXd angle;           // (3m) at corners, radians
  Eigen::VectorXd half_cotangent;  // (3m) half the cotangent of the angle opposite a halfedge
  Eigen::VectorXd area;            // (m) of triangles
  Eigen::VectorXcd apex;           // (m) the last corner from the first one, along the first halfedge and across it
  Eigen::VectorXd vertex_area;     // (n) a third of the triangles around
  Eigen::VectorXd angle_defect;    // (n) 2 pi minus the angle sum, pi minus it on a boundary
  double total_area = 0;
  Array<Index> degenerate;  // triangles without a usable area; lengths are mollified when there are any
};

// A surface with its intrinsic geometry, or another one. Refers to both.
struct MetricMesh {
  const HalfedgeMesh& mesh;
  const Geometry& geometry;
};

// The factor of an edge's length in the metric: the mean of those at its ends, which is exact where they are linear.
inline double edge_scale(const Eigen::VectorXd& scale, Index a, Index b) {
  return scale.size() == 0 ? 1.0 : (scale[a] + scale[b]) / 2;
}

// Degenerate triangles get area: the smallest constant that gives every triangle inequality a margin is added to all
// lengths (Sharp and Crane 2020, section 4.5).
Geometry build_geometry(const HalfedgeMesh& mesh);

// The angle defects of the surface in space, whatever the scale of its metric: those of its shape.
Eigen::VectorXd defects_in_space(const MetricMesh& surface);

// The same with a margin given, in mean edge lengths: fatter triangles, for which more maps are valid.
Geometry mollified(const HalfedgeMesh& mesh, Geometry geometry, double margin);

// A metric with other lengths, (3m), of its edges.
Geometry geometry_of_lengths(const HalfedgeMesh& mesh, Eigen::VectorXd length);

// Two sides of a triangle in the metric, from its first corner.
struct TwoSides {
  double square;        // of the first one's length
  double dot;           // their product
  double doubled_area;  // between them
};
TwoSides two_sides(const Positions& positions, const Triangles& triangles, const Eigen::VectorXd& scale, Index f);

// The normal of a triangle in space; its length is twice the area.
Eigen::Vector3d area_normal(const Positions& positions, const Triangles& triangles, Index f);

// The same, but for a triangle without a usable area that of its neighbor: in the same face, or across its longest
// edge.
Eigen::Vector3d surface_normal(const HalfedgeMesh& mesh, Index f);

// The doubled area between two directions in the plane, positive if the second one is on the left.
inline double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The angle between two directions, radians; 0 if one is zero.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The angle between the surface normals of the triangles on both sides of an inner edge, radians.
double bend_at(const HalfedgeMesh& mesh, Index h);

// The edge vector of halfedge h in its triangle's own frame, in which the triangle's first halfedge is real.
inline Complex edge_vector(const Geometry& geometry, Index h) {
  const Index f = h / 3;
  switch (h % 3) {
    case 0: return {geometry.length[h], 0};
    case 1: return geometry.apex[f] - geometry.length[3 * f];
    default: return -geometry.apex[f];
  }
}

// Its direction in the same frame, radians.
inline double edge_direction(const Geometry& geometry, Index h) {
  const Index first = h - h % 3;
  switch (h % 3) {
    case 0: return 0;
    case 1: return M_PI - geometry.angle[first + 1];
    default: return M_PI + geometry.angle[first];
  }
}

// The cotangent weight of an edge (half the sum of the cotangents opposite), on either of its halfedges.
inline double cotangent_weight(const MetricMesh& surface, Index h) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  return geometry.half_cotangent[h] + (mesh.twin[h] == none ? 0.0 : geometry.half_cotangent[mesh.twin[h]]);
}

}  // namespace lsgp
