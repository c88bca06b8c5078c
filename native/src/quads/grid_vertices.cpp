// SPDX-License-Identifier: GPL-3.0-or-later
#include "quads/grid_vertices.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

// The cost of a point of a row, in multiplications.
constexpr double operations_a_point = 50;

// Quotient rounded down; b > 0.
std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
std::int64_t ceil_divide(std::int64_t a, std::int64_t b) { return -floor_divide(-a, b); }

struct Range {
  std::int64_t low, high;
};

// The x at which a row, between the lowest and the highest corner, is in the closed triangle.
Range in_row(const ExactGrid& grid, Index triangle, std::int64_t y) {
  Range row{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()};
  for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    const GridPoint from = grid.at[h], way = grid.first_side(h);
    // The row is on the left of the side: way.x (y - from.y) >= way.y (x - from.x).
    const std::int64_t bound = way.x * (y - from.y);
    if (way.y > 0) row.high = std::min(row.high, from.x + floor_divide(bound, way.y));
    if (way.y < 0) row.low = std::max(row.low, from.x + ceil_divide(-bound, -way.y));
  }
  return row;
}

}  // namespace

std::optional<Place> find_place(const ExactGrid& grid, Index triangle, GridPoint p) {
  std::array<std::int64_t, 3> side{};
  for (int c = 0; c < 3; ++c) {
    const Index h = 3 * triangle + c;
    element(side, c) = orient(grid.at[h], grid.at[next(h)], p);
    if (element(side, c) < 0) return std::nullopt;
  }
  Place place;
  for (int c = 0; c < 3; ++c) {
    if (element(side, c) > 0) continue;
    if (element(side, (c + 2) % 3) == 0) place.corner = 3 * triangle + c;
    place.edge = 3 * triangle + c;
  }
  if (place.corner != none) place.edge = none;
  return place;
}

GridVertices::GridVertices(const HalfedgeMesh& mesh, const ExactGrid& grid) : mesh_(mesh), grid_(grid) {
  at_vertex_.assign(mesh.vertex_count(), none);
  first_.reserve(mesh.triangle_count() + 1);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    first_.push_back(count());
    add_points_of(f);
  }
  first_.push_back(count());
}

void GridVertices::add_points_of(Index triangle) {
  const std::int64_t cell = grid_.cell();
  const GridPoint a = grid_.at[3 * triangle], b = grid_.at[3 * triangle + 1], c = grid_.at[3 * triangle + 2];
  const std::int64_t top = std::max({a.y, b.y, c.y});
  for (std::int64_t y = ceil_divide(std::min({a.y, b.y, c.y}), cell) * cell; y <= top; y += cell) {
    const Range row = in_row(grid_, triangle, y);
    checkpoint(operations_a_point * (static_cast<double>(row.high - row.low) / static_cast<double>(cell) + 1));
    for (std::int64_t x = ceil_divide(row.low, cell) * cell; x <= row.high; x += cell) {
      const Place place = *find_place(grid_, triangle, {x, y});
      if (!is_home(place)) continue;
      if (place.corner != none) at_vertex_[mesh_.origin(place.corner)] = count();
      all_.push_back({triangle, {x, y}, place});
    }
  }
}

bool GridVertices::is_home(const Place& place) const {
  if (place.corner != none) return mesh_.outgoing[mesh_.origin(place.corner)] == place.corner;
  return place.edge == none || place.edge < mesh_.twin[place.edge];
}

Index GridVertices::find(Index triangle, GridPoint p, const Place& place) const {
  if (place.corner != none) return at_vertex_[mesh_.origin(place.corner)];
  if (!is_home(place)) {
    p = grid_.across[place.edge](p);
    triangle = mesh_.twin[place.edge] / 3;
  }
  const auto begin = all_.begin() + first_[triangle], end = all_.begin() + first_[triangle + 1];
  const auto found = std::lower_bound(begin, end, p, [](const GridVertex& vertex, GridPoint wanted) {
    return vertex.at.y != wanted.y ? vertex.at.y < wanted.y : vertex.at.x < wanted.x;
  });
  return found != end && found->at == p ? static_cast<Index>(found - all_.begin()) : none;
}

}  // namespace lsgp
