// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaping/quad_grid.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "base/text.hpp"
#include "creases/face_quads.hpp"
#include "lsgp/errors.hpp"

namespace lsgp {

namespace {

// Sides of a cell from the lower one on, counter-clockwise.
constexpr int sides = 4;
constexpr std::array<std::array<Index, 2>, sides> beyond{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
constexpr std::array<std::array<Index, 2>, sides> begin_of{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

// Where a quad lies: its cell, and which of the cell's sides its first side is.
struct Cell {
  std::array<Index, 2> place;  // column and row
  int first;
};

[[noreturn]] void refuse_as_no_grid() {
  throw Error(Code::shape_impossible,
              "The quads are no part of a grid: they go round a hole or a corner where not four of them meet. Choose "
              "fewer of them, or cut them.");
}

// From the first one on, across sides.
Array<Cell> find_cells(const HalfedgeMesh& mesh, const Array<Quad>& quads) {
  PerHalfedge<Index> side_of(mesh.halfedge_count(), none);
  for (Index q = 0; q < ssize(quads); ++q) {
    for (int s = 0; s < sides; ++s) side_of[quads[q].side[static_cast<std::size_t>(s)]] = sides * q + s;
  }
  Array<Cell> out(quads.size());
  Array<char> is_placed(quads.size(), 0);
  Array<Index> waiting{0};
  out[0] = {{0, 0}, 0};
  is_placed[0] = 1;
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    const Index q = waiting[i];
    for (int s = 0; s < sides; ++s) {
      const Index twin = mesh.twin[element(quads[q].side, s)];
      if (twin == none) continue;
      const Index other = side_of[twin];
      const int here = (s + out[q].first) % sides, there = (here + sides / 2) % sides;
      const std::array<Index, 2>& step = element(beyond, here);
      const Cell next_to{{out[q].place[0] + step[0], out[q].place[1] + step[1]},
                         (there - other % sides + sides) % sides};
      const Index p = other / sides;
      if (is_placed[p]) {
        if (out[p].place != next_to.place || out[p].first != next_to.first) refuse_as_no_grid();
        continue;
      }
      out[p] = next_to;
      is_placed[p] = 1;
      waiting.push_back(p);
    }
  }
  return out;
}

void require_distinct(const Array<Cell>& cells) {
  Array<std::array<Index, 2>> places;
  for (const Cell& cell : cells) places.push_back(cell.place);
  std::sort(places.begin(), places.end());
  if (std::adjacent_find(places.begin(), places.end()) != places.end()) refuse_as_no_grid();
}

// Where columns, or rows, begin: one more than there are.
Eigen::VectorXd lines_of(const Eigen::VectorXd& sums, const Eigen::VectorXd& counts, GridSpacing spacing) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(sums.size() + 1);
  const double even = sums.sum() / counts.sum();
  for (Eigen::Index i = 0; i < sums.size(); ++i) {
    out[i + 1] = out[i] + (spacing == GridSpacing::even ? even : sums[i] / counts[i]);
  }
  return out;
}

}  // namespace

Eigen::VectorXcd lay_on_grid(const MetricMesh& surface, GridSpacing spacing, Index most_rows) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Array<Quad> quads = find_quads(surface);
  if (2 * ssize(quads) != mesh.triangle_count()) {
    throw Error(Code::shape_impossible, "There are faces that are no quads. Leave them out.");
  }
  Array<Cell> cells = find_cells(mesh, quads);
  require_distinct(cells);
  std::array<Index, 2> low{0, 0}, high{0, 0};
  for (const Cell& cell : cells) {
    for (const std::size_t axis : {0u, 1u}) {
      low[axis] = std::min(low[axis], cell.place[axis]);
      high[axis] = std::max(high[axis], cell.place[axis] + 1);
    }
  }
  const Index columns = high[0] - low[0], rows = high[1] - low[1];
  if (std::min(columns, rows) > most_rows) {
    throw Error(Code::shape_impossible,
                concat("The quads are ", columns, " by ", rows, ", no single row. Choose one row, or a grid."));
  }
  std::array<Eigen::VectorXd, 2> sums{Eigen::VectorXd::Zero(columns), Eigen::VectorXd::Zero(rows)}, counts = sums;
  for (Index q = 0; q < ssize(quads); ++q) {
    for (int s = 0; s < sides; ++s) {
      const int here = (s + cells[q].first) % sides;
      const std::size_t axis = here % 2 == 0 ? 0 : 1;
      const Index line = cells[q].place[axis] - low[axis];
      sums[axis][line] += surface.geometry.length[element(quads[q].side, s)];
      counts[axis][line] += 1;
    }
  }
  const Eigen::VectorXd across = lines_of(sums[0], counts[0], spacing), up = lines_of(sums[1], counts[1], spacing);
  Eigen::VectorXcd out(mesh.vertex_count());
  for (Index q = 0; q < ssize(quads); ++q) {
    for (int s = 0; s < sides; ++s) {
      const std::array<Index, 2>& corner = element(begin_of, (s + cells[q].first) % sides);
      out[mesh.origin(element(quads[q].side, s))] = {across[cells[q].place[0] - low[0] + corner[0]],
                                                     up[cells[q].place[1] - low[1] + corner[1]]};
    }
  }
  return out;
}

}  // namespace lsgp
