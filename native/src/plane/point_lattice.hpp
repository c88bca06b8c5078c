// SPDX-License-Identifier: GPL-3.0-or-later
// The lattice of cones and translations of a seamless layout: a + b g with integers a and b.
#pragma once

#include <array>
#include <cstdint>

#include "lsgp/options.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Rotations of a lattice's layouts are multiples of 2 pi / q.
int symmetry(Lattice lattice);

class PointLattice {
 public:
  using Coordinates = std::array<std::int64_t, 2>;  // a, b

  explicit PointLattice(int symmetry) : symmetry_(symmetry) {}
  int symmetry() const { return symmetry_; }
  bool square() const { return symmetry_ != 3 && symmetry_ != 6; }
  Complex generator() const;  // g: i, or e^{i pi / 3} on triangular lattices
  double cell_area() const { return generator().imag(); }

  // e^{2 pi i turns / q}, exact on square lattices.
  Complex unit(int turns) const;

  Coordinates nearest_coordinates(Complex z) const;
  Complex point(const Coordinates& coordinates) const;
  Complex nearest(Complex z) const { return point(nearest_coordinates(z)); }

 private:
  int symmetry_;
};

}  // namespace lsgp
