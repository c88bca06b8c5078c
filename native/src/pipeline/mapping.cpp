// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "mesh/border.hpp"
#include "pipeline/straightening.hpp"
#include "prescription/border_turning.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/low_stretch.hpp"
#include "repair/untangle.hpp"
#include "systems/quadratic_forms.hpp"
#include "unfold/unfold.hpp"

namespace lsgp {

namespace {

using Kind = DistortionEnergy::Kind;

constexpr double tangled_share = 0.002;  // of the triangles flipped, for which another fit is tried

// A surface with boundary has infinitely many conformal maps, so the spectral step would return an arbitrary one; the
// smallest eigenvector is only meaningful without cones (Mullen et al. 2008).
UnfoldMethod usable_unfold(const HalfedgeMesh& mesh, const ComponentCones& cones, UnfoldMethod asked,
                           std::vector<Finding>& findings) {
  const bool plain_disk =
      mesh.boundary_loops.size() == 1 && mesh.genus == 0 && cones.vertices.empty() && cones.border == BorderMode::free;
  if (asked == UnfoldMethod::poisson || mesh.closed() || plain_disk) return asked;
  findings.push_back(
      {Code::spectral_needs_closed,
       "The spectral unfolding is ill-posed on a surface with boundary and cones; the Poisson unfolding was "
       "used instead.",
       {}});
  return UnfoldMethod::poisson;
}

// A boundary without corners is one straight line along its own translation, but the discrete metric determines the
// angle between two such boundaries only to the mesh's resolution. Its direction is therefore taken from the map
// without straight boundaries, whose translations are consistent.
// natural: (3m) that map.
void turn_cornerless_borders(const HalfedgeMesh& mesh, const Array<Index>& corners, const Eigen::VectorXcd& natural,
                             const Array<Index>& edges, Eigen::VectorXd& directions) {
  const std::size_t loop_count = mesh.boundary_loops.size();
  PerLoop<char> has_corner(loop_count, 0);
  for (const Index v : corners) {
    if (mesh.loop_of_vertex[v] != none) has_corner[mesh.loop_of_vertex[v]] = 1;
  }
  PerLoop<Complex> along(loop_count, 0.0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Complex edge = natural[next(edges[i])] - natural[edges[i]];
    along[mesh.loop_of_vertex[mesh.origin(edges[i])]] +=
        std::polar(1.0, -directions[static_cast<Eigen::Index>(i)]) * edge;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index loop = mesh.loop_of_vertex[mesh.origin(edges[i])];
    if (!has_corner[loop]) directions[static_cast<Eigen::Index>(i)] += std::arg(along[loop]);
  }
}

Eigen::VectorXcd unfold_along_borders(const CutSurface& surface, const ComponentMap& map, const ComponentCones& cones,
                                      const ParallelTransport& connection, const Array<Index>& edges) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Eigen::VectorXd& log_scale = map.curvature.log_scale;
  Eigen::VectorXd directions = metric_directions(mesh, geometry, log_scale, connection.frames, edges);
  const Jacobians jacobians = prescribed_jacobians(mesh, log_scale, connection.frames);
  if (cones.border == BorderMode::straight) {
    const Eigen::VectorXcd natural = PoissonSystem(surface, connection.reduction).fit(jacobians);
    turn_cornerless_borders(mesh, cones.vertices, at_corners(map.cut_mesh, natural), edges, directions);
  }
  return unfold_aligned(surface, connection.reduction, jacobians, edges, directions);
}

// The metric of the surface itself with the angles of another one.
Curvature metric_of(ComponentSystem& system, ComponentCones cones, const Curvature& other) {
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    cones.angles[i] = system.mesh().flat_angle(cones.vertices[i]) - other.at_vertex[cones.vertices[i]];
  }
  std::vector<Finding> unsaid;
  return prescribe(system, cones, PrescriptionRule::manual, unsaid);
}

// Lengths in the layout may differ by no more than e^widest.
void require_range(const Curvature& curvature, double widest) {
  const double range = curvature.log_scale.maxCoeff() - curvature.log_scale.minCoeff();
  if (range < widest) return;
  throw Error(Code::solver_failed,
              concat("With these cones and angles lengths in the layout would differ by a factor of ", factor(range),
                     ", more than numbers can hold. Add cones where the texture becomes too small, or let angles that "
                     "were given be chosen."));
}

}  // namespace

bool repairs(const Options& options) {
  return options.repair && options.method == Method::lsgp && options.unfold == UnfoldMethod::poisson;
}

ComponentMap Mapping::attempt(const ComponentCones& cones, Effort effort, std::vector<Finding>& findings) {
  ComponentMap map;
  {
    const ProgressMonitor::Stage stage(monitor_, "prescribe");
    const ProgressMonitor::Part part(monitor_, 0, 0.2);
    monitor_.advance(0);
    map.curvature = prescribe(system_, cones, options_.prescription, findings);
  }
  {
    const ProgressMonitor::Stage stage(monitor_, "cut");
    monitor_.advance(0.2);
    cut(map);
  }
  const ProgressMonitor::Stage stage(monitor_, "unfold");
  monitor_.advance(0.3);
  const CutSurface surface = open(map);
  if (options_.method == Method::lscm) {
    map.position = unfold_lscm(mesh_, geometry_, map.cut_mesh);
    check(map);
    return map;
  }
  const ParallelTransportChoice connections(surface, map.curvature, cones.symmetry);
  const ParallelTransport connection = connections.at(1, map.curvature);
  map.rotation = connection.rotation;
  const Array<Index> aligned = aligned_edges();
  const bool spectral = usable_unfold(mesh_, cones, options_.unfold, findings) == UnfoldMethod::spectral;
  if (!spectral) require_range(map.curvature, std::log(std::numeric_limits<double>::max()));
  if (spectral) {
    map.position = unfold_spectral(surface, connection.reduction);
  } else if (!aligned.empty()) {
    map.position = unfold_along_borders(surface, map, cones, connection, aligned);
  } else {
    map.position = PoissonSystem(surface, connection.reduction)
                       .fit(prescribed_jacobians(mesh_, map.curvature.log_scale, connection.frames));
  }
  Curvature target = map.curvature;
  if (map.pins.size() > 1) {
    PinnedMap pinned = move_onto_pins(surface, connection.reduction, map.pins, !aligned.empty(), map.position);
    map.position = std::move(pinned.position);
    target.log_scale.array() += std::log(pinned.scale);
  }
  check(map);
  // No repair helps if small triangles are below the rounding error of the large ones.
  if (map.validity.defects() > 0) require_range(map.curvature, -std::log(std::numeric_limits<double>::epsilon()));
  if (!repair_) {
    repair_ = {static_cast<Index>(map.validity.flipped.size()),
               static_cast<Index>(map.validity.wrong_angle_sums.size()), 0};
  }
  if (map.validity.defects() > 0 && repairs(options_) && !spectral) {
    const Array<Index> flipped = map.validity.flipped;
    repair(connections, connection, target, effort, map);
    if (map.validity.defects() == 0) polish(connection, flipped, map);
  }
  return map;
}

void Mapping::approach_angles(ComponentMap& map, std::vector<Finding>& findings) {
  if (task_.cones.border == BorderMode::straight || map.pins.size() > 1 || map.cones.empty()) return;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  ComponentTask automatic = task_;
  automatic.cones.vertices = map.cones;
  for (const Index v : task_.cones.vertices) {
    if (mesh_.loop_of_vertex[v] != none) automatic.cones.vertices.push_back(v);
  }
  automatic.cones.angles.assign(automatic.cones.vertices.size(), std::nullopt);
  automatic.cones.symmetry = 0;
  automatic.cones.holes = Holes::as_given;
  for (std::size_t loop = 0; loop < map.curvature.needs_no_cut.size(); ++loop) {
    if (map.curvature.needs_no_cut[loop]) automatic.cones.loop_turning[loop] = once_around_a_hole;
  }
  Options plain = options_;
  plain.prescription = PrescriptionRule::least_distortion;
  plain.mode = Mode::conformal;
  std::vector<Finding> unsaid;
  ComponentSystem system(mesh_, geometry_, automatic.cones, options_.factorization);
  ComponentMap start = map_component(system, automatic, plain, unsaid, monitor_);
  repair_->iterations += start.repair.iterations;
  if (start.validity.defects() > 0 || start.curvature.needs_no_cut != map.curvature.needs_no_cut) return;
  // Either map may be of fatter triangles, whose metric and cuts are others.
  const Curvature begin = metric_of(system, automatic.cones, start.curvature);
  const Curvature end = task_.cones.symmetry > 0 ? map.curvature : metric_of(system, automatic.cones, map.curvature);
  const CutSurface surface = system.open(start.cut_graph, start.cut_mesh);
  const ParallelTransportChoice connections(surface, end, task_.cones.symmetry);
  Path path = path_between(begin, connections, end);
  path.aligned = aligned_edges();
  Continuation found = follow(surface, path, Effort::global, counter(), {start.position, fixed_vertices(map)});
  if (found.reached < 1) {
    if (task_.cones.symmetry > 0) return;
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
}

void Mapping::relax(ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "relax");
  const CutSurface surface = open(map);
  const ParallelTransport connection = connection_of(map);
  map.position = lower_stretch(surface, {connection, map.curvature}, {options_.stretch, task_.importance}, counter(),
                               {map.position, fixed_vertices(map)});
  check(map);
}

bool Mapping::may_straighten(const ComponentMap& map) const {
  return options_.straighten && task_.cones.symmetry == 0 && !mesh_.closed() && map.validity.defects() == 0 &&
         map.rotation && map.pins.size() < 2 && aligned_edges().empty();
}

void Mapping::straighten(ComponentMap& map) {
  if (!may_straighten(map)) return;
  map.natural_l2 = l2_stretch(geometry_, measure_jacobians(mesh_, geometry_, map.cut_mesh, map.position));
  std::optional<ComponentMap> found;
  if (std::optional<ComponentMap> turned = with_quarter_turns(map)) {
    turned->natural_l2 = map.natural_l2;
    found = straightened(*turned);
  }
  if (!found) found = straightened(map);
  if (found) map = std::move(*found);
}

std::optional<ComponentMap> Mapping::straightened(const ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "relax");
  const CutSurface surface = open(map);
  std::optional<StraightOutline> outline = sides_to_straighten(surface, map, false);
  if (!outline) return std::nullopt;
  return with_straight_sides({surface, connection_of(map), {options_.stretch, task_.importance}, counter()}, map,
                             std::move(*outline));
}

std::optional<ComponentMap> Mapping::with_quarter_turns(const ComponentMap& map) {
  constexpr double nearly = 3 * M_PI / 180, exactly = 1e-9;
  if (!map.cones.empty() || mesh_.genus > 0 || mesh_.boundary_loops.size() < 2) return std::nullopt;
  Eigen::VectorXd turning = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh_.boundary_loops.size()));
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (mesh_.loop_of_vertex[v] != none) turning[mesh_.loop_of_vertex[v]] += map.curvature.at_vertex[v];
  }
  ComponentTask rounded = task_;
  double most = 0;
  for (Eigen::Index loop = 0; loop < turning.size(); ++loop) {
    const double quarters = M_PI / 2 * std::round(turning[loop] / (M_PI / 2));
    most = std::max(most, std::abs(turning[loop] - quarters));
    rounded.cones.loop_turning[loop] = quarters;
  }
  if (most < exactly || most > nearly) return std::nullopt;
  Options plain = options_;
  plain.straighten = false;
  std::vector<Finding> unsaid;
  try {
    ComponentMap out = map_component(system_, rounded, plain, unsaid, monitor_);
    if (may_straighten(out)) return out;
  } catch (const Error& error) {
    if (error.code() != Code::loop_turning && error.code() != Code::solver_failed) throw;
  }
  return std::nullopt;
}

void Mapping::smooth(ComponentMap& map) {
  constexpr int steps = 4;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const ParallelTransport connection = connection_of(map);
  NewtonMinimizer(surface, {map.curvature.log_scale, connection.frames},
                  free_all(mesh_, map.cut_mesh, connection.reduction, fixed_vertices(map)), counter(), map.position)
      .smooth(Kind::conformal_barrier, steps);
  check(map);
}

void Mapping::cut(ComponentMap& map) const {
  for (const Index v : inside_only(mesh_, task_.cones.vertices)) {
    const bool flat = task_.cones.symmetry > 0 && map.curvature.at_vertex[v] == 0;
    (flat ? map.flat_cones : map.cones).push_back(v);
  }
  const PerLoop<char>& uncut = map.curvature.needs_no_cut;
  if (std::find(uncut.begin(), uncut.end(), 1) != uncut.end()) {
    map.cut_graph = system_.connect(map.cones, uncut);
  } else if (map.flat_cones.empty()) {
    map.cut_graph = system_.all_cuts();
  } else {
    map.cut_graph = keep_cones(mesh_, system_.all_cuts(), map.cones);
  }
  for (const Cut& cut : map.cut_graph.cuts) {
    map.required_cuts.insert(map.required_cuts.end(), cut.halfedges.begin(), cut.halfedges.end());
  }
  map.has_straight_cuts = options_.prescription == PrescriptionRule::straightness;
  map.cut_mesh = cut_open(mesh_, map.cut_graph);
  map.pins = pins_of_copies(map.cut_mesh, task_.pinned_corners);
}

void Mapping::check(ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "check");
  check_positions(mesh_, map);
}

void Mapping::repair(const ParallelTransportChoice& connections, const ParallelTransport& connection,
                     const Curvature& target, Effort effort, ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const PerVertex<char> fixed = fixed_vertices(map);
  const bool tangled = static_cast<double>(map.validity.flipped.size()) > tangled_share * mesh_.triangle_count();
  if (tangled && aligned_edges().empty() && map.pins.size() < 2) {
    ComponentMap relative = map;
    const RelativeFit fit(surface, prescribed_jacobians(mesh_, map.curvature.log_scale, connection.frames));
    relative.position = PoissonSystem(fit.surface(), connection.reduction).fit(fit.jacobians());
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

void Mapping::polish(const ParallelTransport& connection, const Array<Index>& flipped, ComponentMap& map) {
  constexpr double sheared = 1.5;  // ratio of the singular values
  constexpr int near = 10, rings = 3, steps = 3;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const CutSurface surface = open(map);
  const Jacobians jacobians = measure_jacobians(mesh_, geometry_, map.cut_mesh, map.position);
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

void Mapping::twist_gradually(const ParallelTransportChoice& connections, const PerVertex<char>& fixed,
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

void Mapping::report_adjusted(const ComponentMap& map, const Continuation& end, std::vector<Finding>& findings) const {
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

ParallelTransport Mapping::connection_of(const ComponentMap& map) const {
  constexpr double same_rotation = 1e-12;  // radians
  const CutSurface surface = open(map);
  ParallelTransport metric = ParallelTransportChoice(surface, map.curvature, task_.cones.symmetry).at(1, map.curvature);
  const auto off = [](double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); };
  for (Eigen::Index p = 0; p < map.rotation->size(); ++p) {
    if (off(metric.rotation[p], (*map.rotation)[p]) > same_rotation) {
      return connection_of_map(surface, map.curvature, *map.rotation, map.position);
    }
  }
  return metric;
}

CutSurface Mapping::open(const ComponentMap& map) const { return system_.open(map.cut_graph, map.cut_mesh); }

Array<Index> Mapping::aligned_edges() const {
  return task_.cones.border == BorderMode::straight ? straight_edges(mesh_, task_.cones.vertices)
                                                    : corner_edges(mesh_, task_.cones.vertices);
}

PerVertex<char> Mapping::fixed_vertices(const ComponentMap& map) const {
  PerVertex<char> fixed(mesh_.vertex_count(), 0);
  for (const Pin& pin : map.pins) fixed[map.cut_mesh.source[pin.copy]] = 1;
  for (const Index h : aligned_edges()) fixed[mesh_.origin(h)] = fixed[mesh_.target(h)] = 1;
  return fixed;
}

StepHook Mapping::counter() {
  return [this] { monitor_.advance(1 - 0.5 * std::pow(0.98, ++repair_->iterations)); };
}

}  // namespace lsgp
