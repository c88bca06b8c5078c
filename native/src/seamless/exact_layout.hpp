// SPDX-License-Identifier: GPL-3.0-or-later
// A layout in numbers representable in single precision, with exact transitions on its lattice.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "plane/point_lattice.hpp"
#include "seamless/rounding_repair.hpp"
#include "seamless/seamless_component.hpp"

namespace lsgp {

// Replaces points almost on the lattice by lattice points, and all others by numbers representable in float32.
class ExactLayout {
 public:
  ExactLayout(const SeamlessComponent& component, const PointLattice& lattice, Complex shift,
              Eigen::VectorXcd& position);

  void snap();

  // Of triangles that rounding has flipped, or left without an area. Edges of features that run along an axis still do,
  // where possible.
  void turn_upright(Array<Index> flipped, PerHalfedge<char> features);

  // The cut edges, as vertex pairs, whose stored sides do not determine the rotation of their cut: some have collapsed
  // to a point.
  Array<Index> find_unreadable() const;

  // Errors as stored: see SeamlessCut.
  Array<SeamlessCut> certify(const Component& component) const;

 private:
  // From the copy on the right of an outgoing cut halfedge to the one on its left, seen from the vertex.
  Complex cross(Complex z, Index h) const;
  Complex turn_across(Index h) const;
  double fraction() const;
  void release_shorter_edges(const Array<Index>& triangles, PerHalfedge<char>& features) const;
  bool is_cone(Index v) const;

  bool on_lattice(Complex z) const { return std::abs(z - lattice_.nearest(z)) < rounding; }

  static constexpr double rounding = 1e-6;  // cells

  const HalfedgeMesh& mesh_;
  const ComponentMap& map_;
  const PointLattice& lattice_;
  const Complex shift_;  // of the lattice that cones are on
  Eigen::VectorXcd& position_;
  PerCut<int> turns_;
  PerCut<Complex> translations_;
};

}  // namespace lsgp
