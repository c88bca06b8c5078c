// SPDX-License-Identifier: GPL-3.0-or-later
// What a map is worth: quality measures (the paper's section 7.1), exactness of its seams, validity.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cut_graph.hpp"
#include "lsgp/result.hpp"
#include "topology.hpp"

namespace lsgp {

using CornerPositions = Eigen::Ref<const Eigen::VectorXcd>;  // (3m) u + iv

// triangles: those to measure, others are left out; triangles without 3D area are skipped.  corner_uv: (3m, 2).
Distortion measure_triangles(const Surface& surface, const CornerUv& corner_uv, const std::vector<Index>& triangles);

// position: at the component's corners.  rotation: (cuts) imposed, radians; none: every cut's own best.
// inexact: where given, receives the cut halfedges whose two sides differ in length or direction by more than rounding
// explains on edges of ordinary length.
SeamQuality measure_seams(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CornerPositions& position,
                          const Eigen::VectorXd* rotation, std::vector<Index>* inexact = nullptr);

// The worse of two in every figure.
SeamQuality worse(const SeamQuality& a, const SeamQuality& b);

// Twice the signed UV area of a triangle.
inline double doubled_area(const CornerPositions& position, Index triangle) {
  const Complex a = position[3 * triangle];
  return std::imag(std::conj(position[3 * triangle + 1] - a) * (position[3 * triangle + 2] - a));
}

// A map is valid when no triangle is flipped and the angles around every vertex add up to what was imposed; without
// flips a sum can still be off, by whole turns, since transitions know angles only modulo 2 pi.
struct Validity {
  std::vector<Index> flipped;           // triangles with UV area <= 0
  std::vector<Index> wrong_angle_sums;  // vertices, off by a turn
  std::vector<Index> inexact_angles;    // vertices off by less, but by more than 1e-6 radians
  double cone_angle_error = 0;          // radians, over vertices of nonzero curvature

  std::size_t defects() const { return flipped.size() + wrong_angle_sums.size(); }
};
// curvature: (n) imposed.  is_free: (n) border vertices that need not have it; their loop's sum has to be right to a
// turn, or the vertex that is off most is named.
Validity check_map(const HalfedgeMesh& mesh, const CornerPositions& position, const Eigen::VectorXd& curvature,
                   const std::vector<char>& is_free);

// Sum of the signed UV angles at every vertex, (n).
Eigen::VectorXd angle_sums(const HalfedgeMesh& mesh, const CornerPositions& position);

}  // namespace lsgp
