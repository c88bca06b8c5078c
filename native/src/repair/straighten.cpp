// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/straighten.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "base/union_find.hpp"
#include "repair/line_constraints.hpp"
#include "unfold/distortion.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr int unfolding_steps = 15;
constexpr double no_coefficient = 1e-9;  // others are around 1
constexpr double rounding = 1e-13;       // of coordinates, to the size of a layout

// Whether the translation of a cut is the unknown that is left out of the reduction, and so 0.
bool is_without_translation(const CutSurface& surface, const ParallelTransport& connection, std::size_t cut) {
  const auto [left, right] = origin_sisters(surface.mesh, surface.cut_mesh, surface.cut_graph.cuts[cut].halfedges[0]);
  const Complex turn = std::polar(1.0, connection.rotation[static_cast<Eigen::Index>(cut)]);
  std::map<Index, Complex> translation;
  connection.reduction.for_each_term(right, [&](const Term& term) { translation[term.unknown] += term.coefficient; });
  connection.reduction.for_each_term(left,
                                     [&](const Term& term) { translation[term.unknown] -= turn * term.coefficient; });
  return std::all_of(translation.begin(), translation.end(),
                     [](const auto& term) { return std::abs(term.second) < no_coefficient; });
}

// A copy of every island but one whose place the unknown that is left out of the reduction determines: that of the copy
// which is held at 0, or else one of those related by the translation which is 0.
Array<Index> held_islands(const CutSurface& surface, const MapTarget& target) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutGraph& cut_graph = surface.cut_graph;
  const CutMesh& cut_mesh = surface.cut_mesh;
  const Reduction& reduction = target.connection.reduction;
  PerTriangle<Index> part;
  Array<Index> first(label_parts(mesh, cut_graph.is_cut, part), none);
  if (first.size() < 2) return {};
  Index placed = none;  // the island whose place follows from the others'
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index copy = cut_mesh.copy_of_corner[corner];
    if (first[part[corner / 3]] == none) first[part[corner / 3]] = copy;
    if (reduction.begin[copy] == reduction.begin[copy + 1]) placed = part[corner / 3];
  }
  for (std::size_t p = 0; p < cut_graph.cuts.size() && placed == none; ++p) {
    const Index h = cut_graph.cuts[p].halfedges.front();
    if (is_without_translation(surface, target.connection, p)) placed = part[h / 3];
  }
  first.erase(first.begin() + std::max(placed, 0));
  return first;
}

DirectedEdges edges_of(const StraightSides& straight) {
  DirectedEdges out;
  for (const StraightSide& side : straight.sides) {
    out.halfedges.insert(out.halfedges.end(), side.halfedges.begin(), side.halfedges.end());
    out.directions.resize(out.halfedges.size(), side.direction);
  }
  return out;
}

// Gives the copies on sides along the axes their mean coordinate across the side, from which they differ by rounding.
// Where they differ by more, as lines that meet at a small angle let them, those on cuts would no longer match.
void equalize(const CutMesh& cut_mesh, const DirectedEdges& edges, Eigen::VectorXcd& position) {
  PositionBox box;
  for (const Complex z : position) box.add(z);
  const double most_off = rounding * box.size();
  for (const bool is_level : {true, false}) {
    UnionFind lines(cut_mesh.copy_count());
    for (Index i = 0; i < ssize(edges.halfedges); ++i) {
      const Complex direction = edges.directions[i];
      if ((is_level ? direction.imag() : direction.real()) != 0) continue;
      const Index h = edges.halfedges[i];
      lines.unite(cut_mesh.copy_of_corner[h], cut_mesh.copy_of_corner[next(h)]);
    }
    struct Line {
      double sum = 0, off = 0;  // of coordinates across it, and their largest distance from the mean
      int count = 0;
    };
    PerCopy<Line> found(cut_mesh.copy_count());
    const auto across = [&](Index copy) { return is_level ? position[copy].imag() : position[copy].real(); };
    for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
      Line& line = found[lines.find(copy)];
      line.sum += across(copy);
      ++line.count;
    }
    for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
      Line& line = found[lines.find(copy)];
      line.off = std::max(line.off, std::abs(across(copy) - line.sum / line.count));
    }
    for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
      const Line& line = found[lines.find(copy)];
      if (line.count == 1 || line.off > most_off) continue;
      const double mean = line.sum / line.count;
      position[copy] = is_level ? Complex(position[copy].real(), mean) : Complex(mean, position[copy].imag());
    }
  }
}

}  // namespace

Eigen::VectorXcd straighten(const CutSurface& surface, const MapTarget& target, const StretchOptions& options,
                            const StepHook& before_step, const MapWithStraightSides& map) {
  const CutMesh& cut_mesh = surface.cut_mesh;
  DirectedEdges edges = edges_of(map.straight);
  Eigen::VectorXcd position = map.straight.turn * map.position;
  if (map.straight.is_bent()) {
    edges.held = held_islands(surface, target);
    const Eigen::VectorXd rest = scale_at_rest(surface, target.curvature, options.stretch, position);
    before_step();
    DegreesOfFreedom freedom = free_along(surface, target.connection.reduction, edges);
    position = FreedomSystem(surface, freedom).fit(measure_jacobians(surface, cut_mesh, position));
    NewtonMinimizer newton(surface, {rest, target.connection.frames}, std::move(freedom), before_step, position);
    newton.weigh(importance_of_triangles(surface, options.importance));
    if (newton.unfold(Kind::foldover_free, unfolding_steps)) relax_stretch(newton);
  }
  equalize(cut_mesh, edges, position);
  return position;
}

}  // namespace lsgp
