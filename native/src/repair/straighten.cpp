// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/straighten.hpp"

#include <cmath>
#include <utility>

#include "base/union_find.hpp"
#include "repair/line_constraints.hpp"
#include "unfold/aligned.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr int unfolding_steps = 15;

DirectedEdges edges_of(const StraightSides& straight) {
  DirectedEdges out;
  for (const StraightSide& side : straight.sides) {
    out.halfedges.insert(out.halfedges.end(), side.halfedges.begin(), side.halfedges.end());
    out.directions.resize(out.halfedges.size(), side.direction);
  }
  return out;
}

// Gives the copies on sides along the axes their mean coordinate across the side, from which they differ by rounding.
void equalize(const CutMesh& cut_mesh, const DirectedEdges& edges, Eigen::VectorXcd& position) {
  for (const bool is_level : {true, false}) {
    UnionFind lines(cut_mesh.copy_count());
    for (Index i = 0; i < ssize(edges.halfedges); ++i) {
      const Complex direction = edges.directions[i];
      if ((is_level ? direction.imag() : direction.real()) != 0) continue;
      const Index h = edges.halfedges[i];
      lines.unite(cut_mesh.copy_of_corner[h], cut_mesh.copy_of_corner[next(h)]);
    }
    PerCopy<std::pair<double, int>> sum(cut_mesh.copy_count(), {0.0, 0});
    const auto across = [&](Index copy) { return is_level ? position[copy].imag() : position[copy].real(); };
    for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
      auto& [coordinates, count] = sum[lines.find(copy)];
      coordinates += across(copy);
      ++count;
    }
    for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
      const auto& [coordinates, count] = sum[lines.find(copy)];
      if (count == 1) continue;
      const double mean = coordinates / count;
      position[copy] = is_level ? Complex(position[copy].real(), mean) : Complex(mean, position[copy].imag());
    }
  }
}

}  // namespace

Eigen::VectorXcd straighten(const CutSurface& surface, const MapTarget& target, const StretchOptions& options,
                            const StepHook& before_step, const MapWithStraightSides& map) {
  const auto& [mesh, geometry, cut_graph, cut_mesh, factor, frame_tree] = surface;
  const DirectedEdges edges = edges_of(map.straight);
  Eigen::VectorXcd position = map.straight.turn * map.position;
  if (map.straight.is_bent()) {
    const Eigen::VectorXd rest = scale_at_rest(surface, target.curvature, options.stretch, position);
    Eigen::VectorXd directions(edges.directions.size());
    for (Eigen::Index i = 0; i < directions.size(); ++i) directions[i] = std::arg(edges.directions[i]);
    before_step();
    position = unfold_aligned(surface, target.connection.reduction,
                              measure_jacobians(mesh, geometry, cut_mesh, position), edges.halfedges, directions);
    NewtonMinimizer newton(surface, {rest, target.connection.frames},
                           free_along(surface, target.connection.reduction, edges), before_step, position);
    newton.weigh(importance_of_triangles(mesh, geometry, options.importance));
    if (newton.unfold(Kind::foldover_free, unfolding_steps)) relax_stretch(newton);
  }
  equalize(cut_mesh, edges, position);
  return position;
}

double l2_stretch(const Geometry& geometry, const Jacobians& jacobians) {
  double stretch = 0, area = 0;
  for (Eigen::Index f = 0; f < jacobians.f_z.size(); ++f) {
    const double p = std::norm(jacobians.f_z[f]), q = std::norm(jacobians.f_zbar[f]);
    stretch += geometry.area[f] * (p + q) / ((p - q) * (p - q));
    area += geometry.area[f] * (p - q);
  }
  return std::sqrt(stretch * area) / geometry.total_area;
}

}  // namespace lsgp
