// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/component_repair.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.hpp"
#include "pipeline/component_unfold.hpp"
#include "pipeline/straightening.hpp"
#include "repair/low_stretch.hpp"
#include "repair/untangle.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr double tangled_share = 0.002;  // of the triangles flipped, for which another fit is tried

}  // namespace

void ComponentRepair::check(ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "check");
  check_positions(mesh_, map);
}

void ComponentRepair::repair(const ParallelTransportChoice& connections, const ParallelTransport& connection,
                             const Curvature& target, Effort effort, ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const PerVertex<char> fixed = fixed_vertices(map);
  const bool tangled = static_cast<double>(map.validity.flipped.size()) > tangled_share * mesh_.triangle_count();
  if (tangled && aligned_edges(mesh_, task_.cones).empty() && map.pins.size() < 2) {
    ComponentMap relative = map;
    relative.position = unfold_relatively(surface, map.curvature, connection);
    check(relative);
    if (relative.validity.defects() < map.validity.defects()) {
      map = std::move(relative);
      if (map.validity.defects() == 0) return smooth(map);
    }
  }
  const auto repair_with = [&](Effort of_repair) {
    const auto first = connections.is_twisted() ? Kind::framed_foldover_free : Kind::foldover_free;
    map.position = untangle(surface, {connection, target}, {of_repair, first}, counter(), {map.position, fixed});
    check(map);
  };
  repair_with(connections.is_twisted() ? Effort::local : effort);
  if (map.validity.defects() == 0 || !connections.is_twisted()) return;
  twist_gradually(connections, fixed, map);
  if (map.validity.defects() > 0) repair_with(Effort::global);
}

void ComponentRepair::polish(const ParallelTransport& connection, const Array<Index>& flipped, ComponentMap& map) {
  constexpr double sheared = 1.5;  // ratio of the singular values
  constexpr int near = 10, rings = 3, steps = 3;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const Jacobians jacobians = measure_jacobians(system_.surface(), map.cut_mesh, map.position);
  const PerVertex<char> around = mark_around(mesh_, flipped, near);
  Array<Index> where;
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    if (!around[mesh_.triangles(f, 0)]) continue;
    const double a = std::abs(jacobians.f_z[f]), b = std::abs(jacobians.f_zbar[f]);
    if (a + b > sheared * (a - b)) where.push_back(f);
  }
  PerVertex<char> marked = mark_around(mesh_, where, rings);
  const PerVertex<char> fixed = fixed_vertices(map);
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (fixed[v] || (mesh_.loop_of_vertex[v] == none && map.curvature.at_vertex[v] != 0)) marked[v] = 0;
  }
  const Eigen::VectorXcd motion = motion_of_copies(mesh_, map.cut_graph, map.cut_mesh, connection.rotation);
  NewtonMinimizer(surface, {map.curvature.log_scale, connection.frames},
                  free_vertices(mesh_, map.cut_mesh, motion, marked), counter(), map.position)
      .smooth(Kind::conformal_barrier, steps);
  check(map);
}

void ComponentRepair::twist_gradually(const ParallelTransportChoice& connections, const PerVertex<char>& fixed,
                                      ComponentMap& map) {
  const CutSurface surface = open(map);
  const ParallelTransport natural = connections.at(0, map.curvature);
  ComponentMap moved = map;
  moved.position = PoissonSystem(surface, natural.reduction)
                       .fit(prescribed_jacobians(mesh_, map.curvature.log_scale, natural.frames));
  moved.position = untangle(surface, {natural, map.curvature}, {Effort::local, Kind::framed_foldover_free}, counter(),
                            {moved.position, fixed});
  check(moved);
  if (moved.validity.defects() > 0) return;
  Continuation end = follow(surface, path_between(map.curvature, connections, map.curvature), Effort::local, counter(),
                            {moved.position, fixed});
  if (end.reached < 1) return;
  map.position = std::move(end.position);
  check(map);
}

void ComponentRepair::smooth(ComponentMap& map) {
  constexpr int steps = 4;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const ParallelTransport connection = connection_of(map);
  NewtonMinimizer(surface, {map.curvature.log_scale, connection.frames},
                  free_all(mesh_, map.cut_mesh, connection.reduction, fixed_vertices(map)), counter(), map.position)
      .smooth(Kind::conformal_barrier, steps);
  check(map);
}

double ComponentRepair::continue_from(ComponentMap start, const MetricChange& metric, ComponentMap& map,
                                      std::vector<Finding>& findings) {
  const CutSurface surface = open(start);
  const ParallelTransportChoice connections(surface, metric.end, task_.cones.rotation_order, task_.strokes());
  Path path = path_between(metric.begin, connections, metric.end);
  path.aligned = aligned_edges(mesh_, task_.cones);
  Continuation found = follow(surface, path, Effort::global, counter(), {start.position, fixed_vertices(map)});
  if (found.reached < 1) {
    if (task_.cones.rotation_order > 0) return found.reached;
    report_adjusted(map, found, findings);
  }
  map.cut_graph = std::move(start.cut_graph);
  map.cut_mesh = std::move(start.cut_mesh);
  map.required_cuts = std::move(start.required_cuts);
  map.pins = std::move(start.pins);
  map.curvature = std::move(found.at.curvature);
  map.rotation = std::move(found.at.connection.rotation);
  map.position = std::move(found.position);
  check(map);
  return found.reached;
}

void ComponentRepair::report_adjusted(const ComponentMap& map, const Continuation& end,
                                      std::vector<Finding>& findings) const {
  double off = 0;
  for (const Index v : task_.cones.vertices) {
    off = std::max(off, std::abs(map.curvature.at_vertex[v] - end.at.curvature.at_vertex[v]));
  }
  findings.push_back(
      {Code::angles_adjusted,
       concat("No map without flips was found for the angles given; this one has angles ",
              std::round(100 * end.reached), " % of the way to them from those of least distortion, up to ",
              rounded(off * 180 / M_PI, 3),
              " degrees off. Take angles nearer to the automatic ones, or subdivide the mesh at ", "the cones."),
       {ElementKind::vertices, task_.cones.vertices}});
}

void ComponentRepair::relax(ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "relax");
  const CutSurface surface = open(map);
  const ParallelTransport connection = connection_of(map);
  map.position = lower_stretch(surface, {connection, map.curvature}, {options_.stretch, task_.importance}, counter(),
                               {map.position, fixed_vertices(map)});
  check(map);
}

bool ComponentRepair::may_straighten(const ComponentMap& map) const {
  const bool has_sides = (options_.straighten && !mesh_.closed()) || mesh_.has_features() || task_.is_strip;
  // On a lattice cuts and features have to fit it as well, which is up to the layout.
  const int order = task_.cones.rotation_order;
  const bool is_free = order == 0 || (order == 4 && map.cut_graph.cuts.empty());
  return has_sides && is_free && map.validity.defects() == 0 && map.rotation && map.pins.size() < 2 &&
         aligned_edges(mesh_, task_.cones).empty();
}

std::optional<ComponentMap> ComponentRepair::straightened(const ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "relax");
  const CutSurface surface = open(map);
  if (task_.is_strip && !mesh_.has_features()) return straightened_as_strip(surface, map);
  const SideKinds kinds = options_.straighten && !mesh_.closed() ? SideKinds::with_sides : SideKinds::marked;
  std::optional<StraightSides> sides = sides_to_straighten(surface, map, kinds);
  if (!sides) return std::nullopt;
  return with_straight_sides({surface, connection_of(map), {options_.stretch, task_.importance}, counter()}, map, kinds,
                             std::move(*sides));
}

std::optional<ComponentMap> ComponentRepair::straightened_as_strip(const CutSurface& surface, const ComponentMap& map) {
  const HalfedgeMesh marked = with_marked_sides(mesh_, map);
  const CutSurface strip{{marked, geometry_}, map.cut_graph, map.cut_mesh, surface.factor, surface.frame_tree};
  std::optional<StraightSides> sides = sides_to_straighten(strip, map, SideKinds::of_strip, LineReading::whole);
  if (!sides) return std::nullopt;
  std::optional<ComponentMap> out =
      with_straight_sides({strip, connection_of(map), {options_.stretch, task_.importance}, counter()}, map,
                          SideKinds::of_strip, std::move(*sides));
  if (out) out->release_reasons.clear();
  return out;
}

ParallelTransport ComponentRepair::connection_of(const ComponentMap& map) const {
  constexpr double same_rotation = 1e-12;  // radians
  const CutSurface surface = open(map);
  ParallelTransport metric =
      ParallelTransportChoice(surface, map.curvature, task_.cones.rotation_order, task_.strokes()).at(1, map.curvature);
  const auto off = [](double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); };
  for (Eigen::Index p = 0; p < map.rotation->size(); ++p) {
    if (off(metric.rotation[p], (*map.rotation)[p]) > same_rotation) {
      return connection_of_map(surface, map.curvature, *map.rotation, map.position);
    }
  }
  return metric;
}

CutSurface ComponentRepair::open(const ComponentMap& map) const { return system_.open(map.cut_graph, map.cut_mesh); }

PerVertex<char> ComponentRepair::fixed_vertices(const ComponentMap& map) const {
  PerVertex<char> fixed(mesh_.vertex_count(), 0);
  for (const Pin& pin : map.pins) fixed[map.cut_mesh.source[pin.copy]] = 1;
  for (const Index h : aligned_edges(mesh_, task_.cones)) fixed[mesh_.origin(h)] = fixed[mesh_.target(h)] = 1;
  return fixed;
}

StepHook ComponentRepair::counter() {
  return [this] { monitor_.advance(1 - 0.5 * std::pow(0.98, ++report_->iterations)); };
}

}  // namespace lsgp
