// SPDX-License-Identifier: GPL-3.0-or-later
#include "quads/exact_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.hpp"

namespace lsgp {

namespace {

constexpr double tolerance = 1e-3;              // cells, by which two sides of an edge may differ
constexpr double most_cells = double(1 << 28);  // so that edges can be numbered
constexpr int product_bits = 30;                // of differences; see grid_point.hpp
constexpr int fewest_bits = 10;                 // no coarser than the tolerance
constexpr double farthest = 1e9;                // cells from the origin

double reach(Complex z) { return std::max(std::abs(z.real()), std::abs(z.imag())); }

Complex turned(Complex z, int turns) {
  switch (turns & 3) {
    case 1: return {-z.imag(), z.real()};
    case 2: return -z;
    case 3: return {z.imag(), -z.real()};
    default: return z;
  }
}

// Binary digits of a cell for which all differences within a triangle and a cell around it stay below the limit.
int fitting_bits(const HalfedgeMesh& mesh, const Eigen::VectorXcd& uv) {
  double longest = 0, outermost = 0, area = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    longest = std::max(longest, reach(uv[next(h)] - uv[h]));
    outermost = std::max(outermost, reach(uv[h]));
    area += 0.5 * (std::conj(uv[h]) * uv[next(h)]).imag();
  }
  int exponent = 0;
  std::frexp(longest + 2, &exponent);
  const int bits = product_bits - exponent;
  if (!(bits >= fewest_bits && outermost < farthest && area < most_cells)) {
    throw Error(Code::wrong_parameter,
                concat("The layout has ", area, " cells and reaches ", outermost,
                       " cells from the origin; that is more than can be traced exactly. Choose larger cells."));
  }
  return bits;
}

class GridBuilder {
 public:
  GridBuilder(const HalfedgeMesh& mesh, const Eigen::VectorXcd& uv) : mesh_(mesh), uv_(uv) {
    grid_.bits = fitting_bits(mesh, uv);
    grid_.at.resize(mesh.halfedge_count());
    grid_.across.resize(mesh.halfedge_count());
    grid_.quarter_turns.assign(mesh.vertex_count(), 0);
  }

  ExactGrid build() {
    find_transitions();
    Array<Index> off_grid;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!place(v, 1) && !place(v, grid_.cell())) off_grid.push_back(v);
    }
    refuse_off_grid(std::move(off_grid));
    require_turning();
    measure_angles();
    return std::move(grid_);
  }

 private:
  // The quarter turn and whole cells that map one side of an edge to the other; returns the deviation.
  double find_transition(Index h) {
    const Index twin = mesh_.twin[h];
    const Complex tail = uv_[h], head = uv_[next(h)], other_tail = uv_[next(twin)], other_head = uv_[twin];
    const Complex ratio = (other_head - other_tail) * std::conj(head - tail);
    const bool along = std::abs(ratio.real()) >= std::abs(ratio.imag());
    const int turns = along ? (ratio.real() >= 0 ? 0 : 2) : (ratio.imag() > 0 ? 1 : 3);
    const Complex way = (other_tail + other_head - turned(tail + head, turns)) / 2.0;
    const Complex whole(std::round(way.real()), std::round(way.imag()));
    const auto cells = [&](double x) { return static_cast<std::int64_t>(x) * grid_.cell(); };
    grid_.across[h] = {turns, {cells(whole.real()), cells(whole.imag())}};
    grid_.across[twin] = grid_.across[h].inverse();
    return std::max(reach(turned(tail, turns) + whole - other_tail), reach(turned(head, turns) + whole - other_head));
  }

  void find_transitions() {
    Array<Index> edges;
    double worst = 0;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (mesh_.twin[h] < h) continue;
      const double error = find_transition(h);
      if (error <= tolerance) continue;
      worst = std::max(worst, error);
      edges.push_back(mesh_.origin(h));
      edges.push_back(mesh_.target(h));
    }
    if (edges.empty()) return;
    const std::string what =
        concat("Across ", count(edges.size() / 2, "edge", "edges"),
               " the layout does not go on by quarter turns and whole cells; it is off by up to ", worst,
               " cells. Make a seamless layout on squares with all cones on its grid, give the side of its "
               "cells, and do not move or scale its islands.");
    throw Error(Code::inexact_seams, what, {ElementKind::edges, std::move(edges)});
  }

  // Rounds a vertex to the multiple of `step` nearest to its first corner, and its other corners accordingly. Returns
  // whether they close around the vertex.
  bool place(Index v, std::int64_t step) {
    const Index first = mesh_.outgoing[v];
    const double scale = static_cast<double>(grid_.cell()) / static_cast<double>(step);
    const auto nearest = [&](double x) { return static_cast<std::int64_t>(std::round(x * scale)) * step; };
    GridPoint at{nearest(uv_[first].real()), nearest(uv_[first].imag())};
    mesh_.for_each_outgoing(v, [&](Index h) {
      grid_.at[h] = at;
      at = grid_.across[prev(h)](at);
    });
    return at == grid_.at[first];
  }

  void require_turning() const {
    Array<Index> flipped;
    for (Index f = 0; f < mesh_.triangle_count(); ++f) {
      if (orient(grid_.at[3 * f], grid_.at[3 * f + 1], grid_.at[3 * f + 2]) <= 0) flipped.push_back(f);
    }
    if (flipped.empty()) return;
    const std::string what =
        concat(count(flipped.size(), "triangle is", "triangles are"),
               " flipped or without area in the layout. Merge needles of the mesh by distance, or make a "
               "layout without, with other cones or smaller cells.");
    throw Error(Code::flipped_triangles, what, {ElementKind::triangles, std::move(flipped)});
  }

  void measure_angles() {
    Array<Index> off_grid, narrow;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      int turns = 0;
      mesh_.for_each_outgoing(v, [&](Index h) {
        for (int direction = 0; direction < 4; ++direction) turns += grid_.leads_into(h, direction);
      });
      grid_.quarter_turns[v] = turns;
      if (turns != 4 && !grid_.is_corner(grid_.at[mesh_.outgoing[v]])) off_grid.push_back(v);
      if (turns == 1) narrow.push_back(v);
    }
    refuse_off_grid(std::move(off_grid));
    if (narrow.empty()) return;
    const std::string what =
        concat(count(narrow.size(), "cone has", "cones have"),
               " an angle of 90 degrees. A single quad would meet itself there: give cones 180 degrees or "
               "more.");
    throw Error(Code::cone_angle_range, what, {ElementKind::vertices, std::move(narrow)});
  }

  static void refuse_off_grid(Array<Index> vertices) {
    if (vertices.empty()) return;
    const std::string what =
        concat(count(vertices.size(), "cone does", "cones do"),
               " not lie on a corner of the grid. Make the layout without parity, and with smaller cells "
               "if cones were left off the grid.");
    throw Error(Code::cones_not_snapped, what, {ElementKind::vertices, std::move(vertices)});
  }

  const HalfedgeMesh& mesh_;
  const Eigen::VectorXcd& uv_;
  ExactGrid grid_;
};

}  // namespace

ExactGrid build_exact_grid(const HalfedgeMesh& mesh, const Eigen::VectorXcd& uv) {
  return GridBuilder(mesh, uv).build();
}

}  // namespace lsgp
