// SPDX-License-Identifier: GPL-3.0-or-later
// The intrinsic triangulation whose only vertices are the cones: it decides whether a layout with moved cones can be
// free of flips.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"

namespace lsgp {

// The position of a triangle's corner in the triangle's own chart:
//   turn * z + sum of coefficient * t,
// z the position of the cone's first copy (its number is the vertex's), t the translations of cuts,
// z_right = e^{i rotation} z_left + t.
struct ConeCorner {
  Index cone;                                     // vertex
  Complex turn;                                   // of modulus 1
  Array<std::pair<Index, Complex>> translations;  // cuts, ascending, and their coefficients
};

// All three corners of a triangle are in one chart, counter-clockwise. A cone can be at several of them. For moved
// cones and translations the corners are valid if these satisfy the closing equations of all nodes.
struct ConeTriangulation {
  Array<std::array<ConeCorner, 3>> triangles;  // 2 (cones - Euler characteristic)
};

// Closed surfaces of any genus.  cones: at least one, and all vertices whose angle is not 2 pi; flat ones may be among
// them.  turn: e^{i rotation}.  position: (copies) u + iv, without flips, the angles around every other vertex
// adding up to 2 pi, both sides of every cut related by its transition.
// None if a vertex cannot be removed, which happens for other positions.
std::optional<ConeTriangulation> triangulate_cones(const CutSurface& surface, const PerCut<Complex>& turn,
                                                   const Array<Index>& cones, const Eigen::VectorXcd& position);

}  // namespace lsgp
