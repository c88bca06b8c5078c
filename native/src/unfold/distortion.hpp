// SPDX-License-Identifier: GPL-3.0-or-later
// Quality measures (the paper's section 7.1), seam residuals and validity of a map.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "lsgp/result.hpp"
#include "mesh/topology.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

using CornerPositions = Eigen::Ref<const Eigen::VectorXcd>;  // (3m) u + iv

// triangles: those to measure; triangles without 3D area are skipped.  corner_uv: (3m, 2).
Distortion measure_triangles(const Surface& surface, const CornerUv& corner_uv, const Array<Index>& triangles);

// The L2 stretch of a map (Sander et al. 2001), up to scale: 1 for an isometry.
class L2Stretch {
 public:
  // Of a triangle: its areas, and the mean square of the stretch from the plane to the surface over all directions,
  // half the sum of the inverse squares of the map's singular values.
  void add(double area, double uv_area, double mean_square) {
    stretch_ += mean_square * area;
    area_ += area;
    uv_area_ += uv_area;
  }
  double value() const { return std::sqrt(stretch_ / area_ * (uv_area_ / area_)); }

 private:
  double stretch_ = 0, area_ = 0, uv_area_ = 0;
};

// The smallest upright box around positions.
class PositionBox {
 public:
  void add(Complex z) {
    low_ = {std::min(low_.real(), z.real()), std::min(low_.imag(), z.imag())};
    high_ = {std::max(high_.real(), z.real()), std::max(high_.imag(), z.imag())};
  }
  Complex low() const { return low_; }
  double size() const { return std::max(std::abs(high_ - low_), std::numeric_limits<double>::min()); }  // its diagonal

 private:
  static constexpr double infinity_ = std::numeric_limits<double>::infinity();
  Complex low_{infinity_, infinity_}, high_{-infinity_, -infinity_};
};

// Cut edges whose two sides are related by one rotation and one translation.
struct SisterEdges {
  Array<Index> halfedges;          // on the left
  std::optional<double> rotation;  // imposed, radians; none: the best fit
  double size;                     // of their layout
};

// position: at the component's corners.  inexact: where given, receives the halfedges whose two sides differ in length
// or direction by more than rounding explains on edges of ordinary length. Edges without a length on the surface have
// neither, and count by their translation alone.
SeamQuality measure_seams(const HalfedgeMesh& mesh, const Array<SisterEdges>& seams, const CornerPositions& position,
                          Array<Index>* inexact = nullptr);

// The same for every cut of a connected layout.  rotation: (cuts) imposed, radians.
SeamQuality measure_seams(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CornerPositions& position,
                          const Eigen::VectorXd* rotation, Array<Index>* inexact = nullptr);

// The maximum of two in every figure.
SeamQuality worse(const SeamQuality& a, const SeamQuality& b);

// Twice the signed UV area of a triangle.
inline double doubled_area(const CornerPositions& position, Index triangle) {
  return doubled_area(position[3 * triangle], position[3 * triangle + 1], position[3 * triangle + 2]);
}

// A map is valid if no triangle is flipped and the angles around every vertex add up to the imposed sum, with negative
// angles for flipped triangles. If seams are exact, a sum can only be off by full turns, since transitions determine
// angles modulo 2 pi; otherwise by any amount.
struct Validity {
  Array<Index> flipped;           // triangles with UV area <= 0
  Array<Index> wrong_angle_sums;  // vertices off by more than a degree
  Array<Index> inexact_angles;    // vertices off by less, but by more than 1e-6 radians
  double cone_angle_error = 0;    // radians, over vertices of nonzero curvature

  std::size_t defects() const { return flipped.size() + wrong_angle_sums.size(); }
};
// curvature: (n) imposed.  is_free: border vertices that need not have it; their loop's sum has to be right to half
// a turn, or the vertex that is off most is named.
Validity check_map(const HalfedgeMesh& mesh, const CornerPositions& position, const Eigen::VectorXd& curvature,
                   const PerVertex<char>& is_free);

// Sum of the signed UV angles at every vertex, (n).
Eigen::VectorXd angle_sums(const HalfedgeMesh& mesh, const CornerPositions& position);

}  // namespace lsgp
