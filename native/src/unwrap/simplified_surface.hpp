// SPDX-License-Identifier: GPL-3.0-or-later
// A surface with few of the triangles of a large one, on which its map is chosen.
#pragma once

#include <vector>

#include "lsgp/completed_cones.hpp"
#include "lsgp/surface.hpp"
#include "mesh/thinned_surface.hpp"

namespace lsgp {

class SimplifiedSurface {
 public:
  // kept: edges that stay, as do boundaries, seams, borders and features.  triangles: about how many are left; more if
  // the others cannot be removed. Neither scale nor directions are carried over.
  SimplifiedSurface(const Surface& whole, const VertexPairs& kept, Index triangles);

  const Surface& surface() const { return surface_; }

  // Pairs of vertices that are left, as those of this surface.
  VertexPairs from_whole(VertexPairs pairs) const;
  // What was found on this surface, as on the whole one.
  VertexPairs on_whole(VertexPairs pairs) const;
  CompletedCones on_whole(CompletedCones cones) const;

 private:
  std::vector<Finding> on_whole(std::vector<Finding> findings) const;
  Eigen::VectorXd on_whole(const Eigen::VectorXd& at_vertices) const;

  ThinnedSurface thinned_;
  VerticesLeft left_;
  PerTriangle<Index> triangle_of_whole_;  // about where each triangle of the whole surface is
  Surface surface_;
};

}  // namespace lsgp
