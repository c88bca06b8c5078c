// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/triangle_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lsgp {

namespace {

// Of a triangle in the surface's metric: the length of its first side, the product of that with the side to the last
// corner, and the doubled area between them.
struct FirstSides {
  double length, dot, doubled;
};

FirstSides first_sides(const Surface& surface, Index f) {
  std::array<Eigen::Vector3d, 3> place;
  for (std::size_t k = 0; k < 3; ++k) place[k] = surface.positions.row(surface.triangles(f, static_cast<Index>(k)));
  if (surface.scale.size() == 0) {
    const Eigen::Vector3d first = place[1] - place[0], second = place[2] - place[0];
    return {first.norm(), first.dot(second), first.cross(second).norm()};
  }
  std::array<double, 3> sides;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double scale = surface.scale[surface.triangles(f, static_cast<Index>(k))] +
                         surface.scale[surface.triangles(f, static_cast<Index>(next))];
    sides[k] = (place[next] - place[k]).norm() * scale / 2;
  }
  const double dot = (sides[0] * sides[0] + sides[2] * sides[2] - sides[1] * sides[1]) / 2;
  auto [c, b, a] = sides;
  if (c > b) std::swap(c, b);
  if (b > a) std::swap(b, a);
  if (c > b) std::swap(c, b);
  // Kahan's stable formula.
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return {sides[0], dot, std::sqrt(std::max(product, 0.0)) / 2};
}

}  // namespace

PerTriangle<double> areas_of(const Surface& surface) {
  PerTriangle<double> out(surface.triangles.rows());
  for (Index f = 0; f < surface.triangles.rows(); ++f) out[f] = first_sides(surface, f).doubled / 2;
  return out;
}

PerTriangle<SingularValues> singular_values(const Surface& surface, const CornerUv& corner_uv) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  PerTriangle<SingularValues> out(surface.triangles.rows());
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    const FirstSides sides = first_sides(surface, f);
    if (!(sides.doubled > 0)) {
      out[f] = {nan, nan};
      continue;
    }
    // The triangle in its own plane: corners 0, length, x + i height.
    const double x = sides.dot / sides.length, height = sides.doubled / sides.length;
    const auto at = [&](Index k) { return Complex(corner_uv(3 * f + k, 0), corner_uv(3 * f + k, 1)); };
    const Complex along = (at(1) - at(0)) / sides.length;
    const Complex across = (at(2) - at(0) - along * x) / height;
    const Complex turned(-across.imag(), across.real());
    const double largest = (std::abs(along - turned) + std::abs(along + turned)) / 2;
    // By the area, not as a difference, which would lose the digits of thin images.
    const double area = std::abs(along.real() * across.imag() - along.imag() * across.real());
    out[f] = {largest, largest == 0 ? 0 : area / largest};
  }
  return out;
}

double uv_area(const CornerUv& corner_uv, Index triangle) {
  const Eigen::RowVector2d first = corner_uv.row(3 * triangle + 1) - corner_uv.row(3 * triangle);
  const Eigen::RowVector2d second = corner_uv.row(3 * triangle + 2) - corner_uv.row(3 * triangle);
  return std::abs(first[0] * second[1] - first[1] * second[0]) / 2;
}

}  // namespace lsgp
