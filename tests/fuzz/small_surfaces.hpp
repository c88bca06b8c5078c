// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of a few triangles, added to what a surface already holds.
#pragma once

#include <cmath>

#include "lsgp/surface.hpp"

inline void add_triangle(lsgp::Triangles& triangles, lsgp::Index a, lsgp::Index b, lsgp::Index c) {
  triangles.conservativeResize(triangles.rows() + 1, 3);
  triangles.bottomRows<1>() << a, b, c;
}

// columns x rows cells, the opposite sides of which may be joined (2 on a torus, 1 on a tube).
inline void add_sheet(lsgp::Surface& surface, lsgp::Index columns, lsgp::Index rows, int joined) {
  const lsgp::Index first = static_cast<lsgp::Index>(surface.positions.rows());
  const lsgp::Index across = columns + (joined < 1), up = rows + (joined < 2);
  surface.positions.conservativeResize(first + across * up, 3);
  for (lsgp::Index j = 0; j < up; ++j) {
    for (lsgp::Index i = 0; i < across; ++i) {
      const double a = 2 * M_PI * i / columns, b = 2 * M_PI * j / rows, ring = 2 + std::cos(b);
      auto point = surface.positions.row(first + j * across + i);
      if (joined == 0) point << i, j, std::sin(i + 0.5 * j);
      if (joined == 1) point << std::cos(a), std::sin(a), 0.5 * j;
      if (joined == 2) point << ring * std::cos(a), ring * std::sin(a), std::sin(b);
    }
  }
  const auto vertex = [&](lsgp::Index i, lsgp::Index j) { return first + (j % up) * across + i % across; };
  for (lsgp::Index j = 0; j < rows; ++j) {
    for (lsgp::Index i = 0; i < columns; ++i) {
      add_triangle(surface.triangles, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      add_triangle(surface.triangles, vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
}

inline void add_double_pyramid(lsgp::Surface& surface, lsgp::Index sides) {
  const lsgp::Index first = static_cast<lsgp::Index>(surface.positions.rows());
  surface.positions.conservativeResize(first + sides + 2, 3);
  for (lsgp::Index i = 0; i < sides; ++i) {
    surface.positions.row(first + i) << std::cos(2 * M_PI * i / sides), std::sin(2 * M_PI * i / sides), 0.1 * (i % 2);
    add_triangle(surface.triangles, first + i, first + (i + 1) % sides, first + sides);
    add_triangle(surface.triangles, first + (i + 1) % sides, first + i, first + sides + 1);
  }
  surface.positions.row(first + sides) << 0, 0, 1.3;
  surface.positions.row(first + sides + 1) << 0.1, 0, -0.8;
}
