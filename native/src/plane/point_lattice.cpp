// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/point_lattice.hpp"

#include <cmath>
#include <complex>

#include "base/array.hpp"

namespace lsgp {

namespace {

const double height = std::sqrt(0.75);  // of a triangle of side 1

}  // namespace

int rotation_order(Lattice lattice) {
  switch (lattice) {
    case Lattice::square: return 4;
    case Lattice::stripe: return 2;
    case Lattice::translation: return 1;
    case Lattice::triangle: return 3;
    case Lattice::hexagon: return 6;
  }
  return 4;
}

Complex PointLattice::generator() const { return square() ? Complex(0, 1) : Complex(0.5, height); }

Complex PointLattice::unit(int turns) const {
  // Twelfths of a full turn.
  static const std::array<Complex, 12> units{Complex{1, 0},   {height, 0.5},  {0.5, height},  {0, 1},
                                             {-0.5, height},  {-height, 0.5}, {-1, 0},        {-height, -0.5},
                                             {-0.5, -height}, {0, -1},        {0.5, -height}, {height, -0.5}};
  return element(units, (turns % rotation_order_ + rotation_order_) % rotation_order_ * (12 / rotation_order_));
}

PointLattice::Coordinates PointLattice::nearest_coordinates(Complex z) const {
  if (square()) return {std::llround(z.real()), std::llround(z.imag())};
  const double b = z.imag() / height, a = z.real() - b / 2;
  Coordinates best{};
  double least = -1;
  for (const double near_a : {std::floor(a), std::floor(a) + 1}) {
    for (const double near_b : {std::floor(b), std::floor(b) + 1}) {
      const Coordinates tried{static_cast<std::int64_t>(near_a), static_cast<std::int64_t>(near_b)};
      const double distance = std::norm(z - point(tried));
      if (least >= 0 && distance >= least) continue;
      least = distance;
      best = tried;
    }
  }
  return best;
}

Complex PointLattice::point(const Coordinates& coordinates) const {
  return static_cast<double>(coordinates[0]) + static_cast<double>(coordinates[1]) * generator();
}

}  // namespace lsgp
