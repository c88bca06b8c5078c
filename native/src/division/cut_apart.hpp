// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a map into parts that move.
#pragma once

#include <complex>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// z -> e^{i angle} z + shift.
struct Motion {
  double angle = 0;
  Complex shift = 0;

  Complex operator()(Complex z) const { return std::polar(1.0, angle) * z + shift; }
  Motion operator*(const Motion& first) const { return {angle + first.angle, (*this)(first.shift)}; }
  Motion inverse() const { return {-angle, -std::polar(1.0, -angle) * shift}; }
};

// Cuts the map at all marked edges, and only there, and moves its parts.
// is_cut: on both halfedges.
void cut_apart(const HalfedgeMesh& mesh, PerHalfedge<char> is_cut, const PerTriangle<Index>& part,
               const PerPart<Motion>& motion, ComponentMap& map);

}  // namespace lsgp
