// SPDX-License-Identifier: GPL-3.0-or-later
// The lattice of cones and translations of a seamless layout: a + b g with integers a and b.
#pragma once

#include <array>
#include <cstdint>

#include "lsgp/options.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Rotations of a lattice's layouts are multiples of 2 pi / q.
int rotation_order(Lattice lattice);

class PointLattice {
 public:
  using Coordinates = std::array<std::int64_t, 2>;  // a, b

  explicit PointLattice(int rotation_order) : rotation_order_(rotation_order) {}
  int rotation_order() const { return rotation_order_; }
  bool square() const { return rotation_order_ != 3 && rotation_order_ != 6; }
  Complex generator() const;  // g: i, or e^{i pi / 3} on triangular lattices
  double cell_area() const { return generator().imag(); }

  // e^{2 pi i turns / q}, exact on square lattices.
  Complex unit(int turns) const;

  Coordinates nearest_coordinates(Complex z) const;
  Complex point(const Coordinates& coordinates) const;
  Complex nearest(Complex z) const { return point(nearest_coordinates(z)); }

 private:
  int rotation_order_;
};

}  // namespace lsgp
