// SPDX-License-Identifier: GPL-3.0-or-later
// A coarse intrinsic triangulation of a surface, for functions that vary slowly over it.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/border.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// Vertices are removed by edge flips until few are left (Liu et al. 2023). Flat regions stay isometric; removing a
// curved vertex changes the metric only within its last three triangles.
class CoarseSurface {
 public:
  // kept: (n) vertices that stay; those of boundaries do as well.  nodes: about how many vertices are left; more if
  // they cannot be removed.
  CoarseSurface(const MetricMesh& surface, const PerVertex<char>& kept, Index nodes);

  Index node_count() const { return node_count_; }
  Index node(Index vertex) const { return node_of_vertex_[vertex]; }  // none where it was removed

  // Of nodes: without positions and lengths, but with the areas and angle defects of the vertices, summed as below.
  MetricMesh surface() const { return {mesh_, geometry_}; }

  // The sum of values at vertices (n) to each node, (nodes): the transpose of `at_vertices`.
  Eigen::VectorXd at_nodes(Eigen::VectorXd values) const;
  // The piecewise linear interpolation of values at nodes, (n).
  Eigen::VectorXd at_vertices(const Eigen::VectorXd& values) const;

  BorderConditions at_nodes(const BorderConditions& border) const;

 private:
  // A vertex and its barycentric coordinates in the triangle that it left.
  struct Removal {
    Index vertex;
    Index corner[3];
    double share[3];
  };
  class Triangulation;

  PerVertex<Index> node_of_vertex_;
  Array<Removal> removals_;  // in that order
  Index node_count_ = 0;
  HalfedgeMesh mesh_;  // triangles, twins, outgoing halfedges and Euler characteristic alone
  Geometry geometry_;  // half cotangents, areas of nodes and angle defects alone
};

}  // namespace lsgp
