// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a layout in integers, the motions that preserve its grid, and exact predicates.
//
// Coordinates are in binary fractions of a cell. Those of points that a predicate compares differ by less than 2^30, so
// that 64 bits hold its products.
#pragma once

#include <cstdint>

namespace lsgp {

struct GridPoint {
  std::int64_t x = 0, y = 0;
};

inline GridPoint operator+(GridPoint a, GridPoint b) { return {a.x + b.x, a.y + b.y}; }
inline GridPoint operator-(GridPoint a, GridPoint b) { return {a.x - b.x, a.y - b.y}; }
inline bool operator==(GridPoint a, GridPoint b) { return a.x == b.x && a.y == b.y; }
inline bool operator!=(GridPoint a, GridPoint b) { return !(a == b); }

inline std::int64_t cross(GridPoint a, GridPoint b) { return a.x * b.y - a.y * b.x; }
inline std::int64_t dot(GridPoint a, GridPoint b) { return a.x * b.x + a.y * b.y; }

// Twice the area of a triangle: positive where c is left of the line from a to b.
inline std::int64_t orient(GridPoint a, GridPoint b, GridPoint c) { return cross(b - a, c - a); }

// Rotates counter-clockwise about the origin by quarter turns.
inline GridPoint turned(GridPoint p, int turns) {
  switch (turns & 3) {
    case 1: return {-p.y, p.x};
    case 2: return {-p.x, -p.y};
    case 3: return {p.y, -p.x};
    default: return p;
  }
}

// The directions of the grid are numbered 0 to 3, counter-clockwise from x.
inline GridPoint axis(int direction) { return turned({1, 0}, direction); }

// From the chart of one triangle to that of its neighbor: p -> i^turns p + shift.
struct GridTransition {
  int turns = 0;
  GridPoint shift{};  // whole cells

  GridPoint operator()(GridPoint p) const { return turned(p, turns) + shift; }
  int direction(int of) const { return (of + turns) & 3; }
  GridTransition inverse() const {
    const GridPoint back = turned(shift, 4 - turns);
    return {(4 - turns) & 3, {-back.x, -back.y}};
  }
};

// Whether a direction is that of `side` or less than a half turn counter-clockwise from it.
inline bool is_from(GridPoint side, GridPoint direction) {
  const std::int64_t turn = cross(side, direction);
  return turn > 0 || (turn == 0 && dot(side, direction) > 0);
}

}  // namespace lsgp
