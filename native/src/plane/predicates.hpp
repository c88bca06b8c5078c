// SPDX-License-Identifier: GPL-3.0-or-later
// Products and orientation tests of points u + iv.
#pragma once

#include <cmath>
#include <complex>
#include <limits>

#include "lsgp/surface.hpp"

namespace lsgp {

// The signed area of the parallelogram of two vectors, positive if b is counter-clockwise from a.
inline double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

// Twice the signed area of a triangle, positive if it is counter-clockwise.
inline double doubled_area(Complex a, Complex b, Complex c) { return cross(b - a, c - a); }

// Whether a vector is along u or along v, exactly.
inline bool is_along_axis(Complex a) { return (a.real() == 0) != (a.imag() == 0); }

// The side of the line from a to b on which c lies: 1 left, -1 right, 0 if rounding leaves it undecided (Shewchuk
// 1997).
inline int side(Complex a, Complex b, Complex c) {
  constexpr double last_digit = std::numeric_limits<double>::epsilon();
  const Complex along = b - a, to = c - a;
  const double left = along.real() * to.imag(), right = along.imag() * to.real();
  const double bound = 2 * last_digit * (std::abs(left) + std::abs(right));
  return left - right > bound ? 1 : left - right < -bound ? -1 : 0;
}

}  // namespace lsgp
