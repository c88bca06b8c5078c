// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "pipeline/component_repair.hpp"
#include "pipeline/component_unfold.hpp"
#include "pipeline/directed_borders.hpp"
#include "pipeline/missing_seams.hpp"
#include "pipeline/straightening.hpp"
#include "prescription/border_turning.hpp"
#include "prescription/parallel_transport.hpp"
#include "prescription/stroke_fit.hpp"
#include "repair/flat_metric.hpp"
#include "solvers/failure.hpp"
#include "unfold/jacobians.hpp"
#include "unfold/lscm.hpp"
#include "unfold/spectral.hpp"

namespace lsgp {

namespace {

// Ranges of the automatic angles: wide ones distort least but may leave turns with neighboring vertices; a map of
// angles up to 2 pi that has no flips has the right angles too.
constexpr AngleRange angle_ranges[]{widest_angles, {M_PI / 2, 2.5 * M_PI}, {M_PI / 2, 2 * M_PI, false}};

constexpr double same_angle = 1e-9;    // radians
constexpr double as_predicted = 1.03;  // times the L2 stretch

// Of triangles made fatter, see `mollified`; in the end hardly any edge is longer than others.
constexpr double fat_margins[]{0.2, 1};

bool any_given(const ComponentCones& cones) {
  return std::any_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

bool all_given(const ComponentCones& cones) {
  return std::all_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

// Whether angles are chosen for least distortion.
bool chooses_angles(const Options& options, const ComponentCones& cones) {
  return options.prescription == PrescriptionRule::least_distortion ||
         (options.prescription == PrescriptionRule::manual && !all_given(cones));
}

bool closes_holes(const ComponentMap& map) {
  const PerLoop<char>& closed = map.curvature.needs_no_cut;
  return std::find(closed.begin(), closed.end(), 1) != closed.end();
}

bool repairs_maps(const Options& options) {
  return options.repair && options.method == Method::lsgp && options.unfold == UnfoldMethod::poisson;
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

// The metric of the surface itself with the angles of another one.
Curvature metric_of(ComponentSystem& system, ComponentCones cones, const Curvature& other) {
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    cones.angles[i] = system.mesh().flat_angle(cones.vertices[i]) - other.at_vertex[cones.vertices[i]];
  }
  std::vector<Finding> unsaid;
  return prescribe(system, cones, PrescriptionRule::manual, unsaid);
}

class Mapping {
 public:
  // system: of the task's cones.
  Mapping(ComponentSystem& system, const ComponentTask& task, const Options& options, ProgressMonitor& monitor)
      : system_(system),
        task_(task),
        options_(options),
        monitor_(monitor),
        repairs_(repairs_maps(options)),
        repairs_hard_(repairs_ && options.hard_repairs) {}

  // What `map_component` and `attempt_component` return.
  ComponentMap best(std::vector<Finding>& findings);
  ComponentMap first(std::vector<Finding>& findings);

 private:
  // Tries angles and geometries, local repairs first; returns the map with the fewest defects.
  FoundMap find_valid_map(const ComponentTask& task);
  // The map with these cones, repaired as far as the effort goes. None if their curvatures are among those tried, which
  // they join otherwise: ranges of angles differ only where they bound one.
  std::optional<FoundMap> attempt(ComponentSystem& system, const ComponentTask& task, Effort effort,
                                  Array<Eigen::VectorXd>& tried);
  void prescribe_angles(ComponentSystem& system, const ComponentTask& task, FoundMap& found);
  void cut(ComponentSystem& system, const ComponentTask& task, ComponentMap& map);
  void unfold_and_repair(ComponentSystem& system, const ComponentTask& task, Effort effort, FoundMap& found);

  // Holes are closed where that is predicted to stretch hardly more, but a coarse belt cannot bend into a ring.
  bool closes_holes_badly(const FoundMap& found) const;
  ComponentTask with_open_holes() const;
  bool is_better(const FoundMap& opened, const FoundMap& closed) const;
  double l2_of(const ComponentMap& map) const;

  // A metric whose angles add up as they have to is found more often than a map. Its own map is as exact.
  void map_flat_metric(FoundMap& found);
  // Automatic angles and rotations about handles chosen for strokes, if the map gains by it.
  bool may_follow_strokes() const;
  bool may_turn_handles() const { return task_.cones.rotation_order > 0 && system_.mesh().genus > 0; }
  void follow_strokes(FoundMap& found);
  double misalignment(const ComponentMap& map) const;
  // Prescribed angles for which no valid map is found directly can often be reached by continuation from angles that
  // have one.
  void approach_angles(FoundMap& found);
  // The task without its angles, to start from.  map: with them, and the holes it closes.
  ComponentTask with_automatic_angles(const ComponentMap& map) const;
  // Continues that map on a surface whose triangles may be fatter; how far it came, 1 being all the way.
  double approach_from(const ComponentMap& start, ComponentSystem& system, const ComponentCones& cones,
                       FoundMap& found);
  // Straightens the nearly straight sides of the boundary of a valid map of low stretch and aligns them with the axes;
  // leaves the map unchanged if that costs noticeable stretch.
  void straighten(ComponentMap& map);
  // The creases inside as well: on the lattice, islands stay as they are.
  void straighten_for_lattice(ComponentMap& map);
  // The map of low stretch whose boundaries turn by multiples of a quarter turn, if they nearly do; none if they
  // already do or if they are far from it.
  std::optional<ComponentMap> with_quarter_turns(const ComponentMap& map);

  ComponentRepair repair_on(ComponentSystem& system, const ComponentTask& task) {
    return {system, task, options_, monitor_, report_};
  }

  ComponentSystem& system_;
  const ComponentTask& task_;
  const Options& options_;
  ProgressMonitor& monitor_;
  const bool repairs_, repairs_hard_;
  std::optional<RepairReport> report_;  // the defects of the first attempt, and the steps of all attempts
};

ComponentMap Mapping::best(std::vector<Finding>& findings) {
  const bool cuts_seams_only = options_.seams == SeamMode::exact;
  if (cuts_seams_only) require_opened(system_, task_.cones);
  FoundMap found = find_valid_map(task_);
  const bool may_open = task_.cones.holes == Holes::where_cheap || task_.cones.holes == Holes::all;
  const bool chooses_holes = may_open && !cuts_seams_only;
  const bool fails_to_close = found.defects() > 0 && repairs_ && closes_holes(found.map) && chooses_holes;
  if (fails_to_close || closes_holes_badly(found)) {
    FoundMap opened = find_valid_map(with_open_holes());
    if (is_better(opened, found)) found = std::move(opened);
  }
  if (found.defects() > 0 && repairs_hard_) {
    try {
      map_flat_metric(found);
    } catch (const SolverFailure&) {
      // What was found before remains.
    }
  }
  if (found.defects() > 0 && repairs_hard_ && (any_given(task_.cones) || task_.cones.rotation_order > 0))
    approach_angles(found);
  if (found.defects() == 0 && may_follow_strokes()) follow_strokes(found);
  if (found.defects() == 0) {
    const bool is_relaxed = options_.mode == Mode::low_stretch && options_.stretch > 0;
    if (is_relaxed) repair_on(system_, task_).relax(found.map);
    if (is_relaxed || options_.seamless) straighten(found.map);
    if (options_.seamless) straighten_for_lattice(found.map);
  }
  if (cuts_seams_only) report_missing_seams(system_, task_, found.map.curvature, found.findings);
  found.map.repair = report_.value_or(RepairReport{});
  findings.insert(findings.end(), found.findings.begin(), found.findings.end());
  return std::move(found.map);
}

ComponentMap Mapping::first(std::vector<Finding>& findings) {
  Array<Eigen::VectorXd> untried;
  FoundMap found = std::move(*attempt(system_, task_, Effort::local, untried));
  if (closes_holes_badly(found)) {
    untried.clear();
    FoundMap opened = std::move(*attempt(system_, with_open_holes(), Effort::local, untried));
    if (is_better(opened, found)) found = std::move(opened);
  }
  found.map.repair = report_.value_or(RepairReport{});
  findings.insert(findings.end(), found.findings.begin(), found.findings.end());
  return std::move(found.map);
}

bool Mapping::closes_holes_badly(const FoundMap& found) const {
  const bool is_choice = repairs_ && task_.cones.holes == Holes::where_cheap && closes_holes(found.map);
  return is_choice && found.defects() == 0 && l2_of(found.map) > as_predicted * found.map.curvature.predicted_l2;
}

ComponentTask Mapping::with_open_holes() const {
  ComponentTask out = task_;
  out.cones.holes = Holes::as_they_are;
  return out;
}

bool Mapping::is_better(const FoundMap& opened, const FoundMap& closed) const {
  if (opened.defects() > 0 || closed.defects() > 0) return opened.defects() < closed.defects();
  return as_predicted * l2_of(opened.map) < l2_of(closed.map);
}

double Mapping::l2_of(const ComponentMap& map) const {
  return l2_stretch(system_.geometry(), measure_jacobians(system_.surface(), map.cut_mesh, map.position));
}

FoundMap Mapping::find_valid_map(const ComponentTask& task) {
  const bool is_free = repairs_ && task.cones.rotation_order == 0 && chooses_angles(options_, task.cones);
  const HalfedgeMesh& mesh = system_.mesh();
  const Geometry& geometry = system_.geometry();
  std::optional<FoundMap> best;
  std::optional<Geometry> fat;
  std::optional<ComponentSystem> fat_system;
  bool is_known_possible = false;
  for (const Effort effort : {Effort::local, Effort::global}) {
    if (effort == Effort::global && !repairs_hard_) break;
    // Local repairs are first tried on the surface itself; hard cases are easier on fat triangles.
    for (const bool is_fat : {effort == Effort::global, effort == Effort::local}) {
      if (is_fat && !fat) {
        fat = mollified(mesh, geometry, fat_margins[0]);
        fat_system.emplace(MetricMesh{mesh, *fat}, task.cones, options_.factorization);
      }
      Array<Eigen::VectorXd> tried;
      for (std::size_t i = 0; i < (is_free ? std::size(angle_ranges) : 1); ++i) {
        ComponentTask ranged = task;
        if (is_free) ranged.cones.range = angle_ranges[i];
        std::optional<FoundMap> found;
        try {
          found = attempt(is_fat ? *fat_system : system_, ranged, effort, tried);
        } catch (const Error& error) {
          if (!best || error.code() != Code::solver_failed) throw;
          continue;
        }
        if (!found) continue;
        if (!best || found->defects() < best->defects()) {
          if (is_fat && found->defects() == 0) repair_on(system_, task).smooth(found->map);
          best = std::move(*found);
        }
        if (best->defects() == 0) return std::move(*best);
        // A valid map would have been proof that its angles are possible.
        const bool has_angles = options_.method == Method::lsgp;
        if (has_angles && !is_known_possible) {
          require_possible(system_.surface(), task.cones, best->map.curvature.log_scale);
          is_known_possible = true;
        }
        if (!repairs_) return std::move(*best);
      }
    }
  }
  return std::move(*best);
}

std::optional<FoundMap> Mapping::attempt(ComponentSystem& system, const ComponentTask& task, Effort effort,
                                         Array<Eigen::VectorXd>& tried) {
  FoundMap found;
  prescribe_angles(system, task, found);
  const Eigen::VectorXd curvature = found.map.curvature.at_vertex(task.cones.vertices);
  for (const Eigen::VectorXd& other : tried) {
    if ((curvature - other).cwiseAbs().sum() <= same_angle) return std::nullopt;
  }
  tried.push_back(curvature);
  cut(system, task, found.map);
  unfold_and_repair(system, task, effort, found);
  return found;
}

void Mapping::prescribe_angles(ComponentSystem& system, const ComponentTask& task, FoundMap& found) {
  const ProgressMonitor::Stage stage(monitor_, "prescribe");
  const ProgressMonitor::Interval interval(monitor_, 0, 0.2);
  monitor_.advance(0);
  found.map.holes = task.cones.holes;
  found.map.curvature = prescribe(system, task.cones, options_.prescription, found.findings,
                                  task.strokes_price ? &task.directions : nullptr);
}

void Mapping::cut(ComponentSystem& system, const ComponentTask& task, ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor_, "cut");
  monitor_.advance(0.2);
  const HalfedgeMesh& mesh = system.mesh();
  for (const Index v : inside_only(mesh, task.cones.vertices)) {
    const bool flat = task.cones.rotation_order > 0 && map.curvature.at_vertex[v] == 0;
    (flat ? map.flat_cones : map.cones).push_back(v);
  }
  map.has_straight_cuts = options_.prescription == PrescriptionRule::straightness;
  if (closes_holes(map)) {
    map.cut_graph = system.connect(map.cones, map.curvature.needs_no_cut);
  } else {
    const CutGraph& cuts = map.has_straight_cuts ? system.straight_cuts() : system.all_cuts();
    map.cut_graph = map.flat_cones.empty() ? cuts : keep_cones(mesh, cuts, map.cones);
  }
  map.required_cuts = halfedges_of(map.cut_graph);
  if (options_.seams == SeamMode::exact) require_seams(mesh, map.required_cuts, !map.cones.empty());
  map.cut_mesh = cut_open(mesh, map.cut_graph);
  map.pins = pins_of_copies(map.cut_mesh, task.pinned_corners);
}

void Mapping::unfold_and_repair(ComponentSystem& system, const ComponentTask& task, Effort effort, FoundMap& found) {
  const ProgressMonitor::Stage stage(monitor_, "unfold");
  monitor_.advance(0.3);
  ComponentMap& map = found.map;
  ComponentRepair repair = repair_on(system, task);
  const CutSurface surface = system.open(map.cut_graph, map.cut_mesh);
  if (options_.method == Method::lscm) {
    map.position = unfold_lscm(system.surface(), map.cut_mesh);
    return repair.check(map);
  }
  const ParallelTransportChoice connections(surface, map.curvature, task.cones.rotation_order, task.strokes());
  const ParallelTransport connection = connections.at(1, map.curvature);
  map.rotation = connection.rotation;
  const bool is_spectral =
      usable_unfold(system.mesh(), task.cones, options_.unfold, found.findings) == UnfoldMethod::spectral;
  if (!is_spectral) require_range(map.curvature, std::log(std::numeric_limits<double>::max()));
  map.position = is_spectral ? unfold_spectral(surface, connection.reduction)
                             : unfold_poisson(surface, map, task.cones, connection);
  Curvature target = map.curvature;
  if (map.pins.size() > 1) {
    const bool is_aligned = !aligned_edges(system.mesh(), task.cones).empty();
    PinnedMap pinned = move_onto_pins(surface, connection.reduction, map.pins, is_aligned, map.position);
    map.position = std::move(pinned.position);
    target.log_scale.array() += std::log(pinned.scale);
  }
  repair.check(map);
  // No repair helps if small triangles are below the rounding error of the large ones.
  if (map.validity.defects() > 0) require_range(map.curvature, -std::log(std::numeric_limits<double>::epsilon()));
  if (!report_) {
    report_ = {static_cast<Index>(map.validity.flipped.size()),
               static_cast<Index>(map.validity.wrong_angle_sums.size()), 0};
  }
  if (map.validity.defects() > 0 && repairs_ && !is_spectral) {
    const Array<Index> flipped = map.validity.flipped;
    repair.repair(connections, connection, target, effort, map);
    if (map.validity.defects() == 0) repair.polish(connection, flipped, map);
  }
}

bool Mapping::may_follow_strokes() const {
  return repairs_ && options_.follow_strokes && (chooses_angles(options_, task_.cones) || may_turn_handles()) &&
         task_.pinned_corners.size() < 2 && are_strokes(task_.directions, system_.geometry());
}

double Mapping::misalignment(const ComponentMap& map) const {
  return misalignment_on_lattice(task_.directions, at_corners(map.cut_mesh, map.position),
                                 std::max(task_.cones.rotation_order, 1));
}

void Mapping::follow_strokes(FoundMap& found) {
  constexpr double prices[] = {200, 40, 10};  // of what rotations about handles miss
  const DirectedMap usual{l2_of(found.map), misalignment(found.map)};
  ComponentTask toward = task_;
  for (const double price : prices) {
    toward.strokes_price = price;
    Array<Eigen::VectorXd> untried;
    try {
      FoundMap tried = std::move(*attempt(system_, toward, Effort::local, untried));
      if (tried.defects() == 0 && is_worth_strokes({l2_of(tried.map), misalignment(tried.map)}, usual)) {
        found = std::move(tried);
        return;
      }
    } catch (const Error& error) {
      if (error.code() != Code::solver_failed) throw;
    }
    if (!may_turn_handles()) return;  // other prices have no effect
  }
}

void Mapping::map_flat_metric(FoundMap& found) {
  const ComponentCones& cones = task_.cones;
  const bool has_turning = std::any_of(cones.loop_turning.begin(), cones.loop_turning.end(),
                                       [](const auto& turning) { return turning.has_value(); });
  const bool has_directions = found.map.pins.size() > 1 || !aligned_edges(system_.mesh(), cones).empty();
  if (cones.rotation_order > 0 || has_turning || has_directions || cones.border == BorderMode::straight) return;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const std::optional<Geometry> flat = find_flat_metric(system_.surface(), required_angles(system_.surface(), cones),
                                                        repair_on(system_, task_).counter());
  if (!flat) return;
  ComponentTask flat_task = task_;
  flat_task.cones.holes = Holes::as_given;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Index v = cones.vertices[i];
    flat_task.cones.angles[i] = system_.mesh().flat_angle(v) - flat->angle_defect[v];
  }
  ComponentSystem flat_system({system_.mesh(), *flat}, cones, options_.factorization);
  Array<Eigen::VectorXd> untried;
  FoundMap other = std::move(*attempt(flat_system, flat_task, Effort::local, untried));
  if (other.defects() > 0) return;
  const Curvature own = metric_of(system_, cones, other.map.curvature);
  other.map.curvature.log_scale = own.log_scale;
  other.map.curvature.predicted_l2 = own.predicted_l2;
  repair_on(system_, task_).smooth(other.map);
  found = std::move(other);
}

void Mapping::approach_angles(FoundMap& found) {
  const ComponentMap& map = found.map;
  if (task_.cones.border == BorderMode::straight || map.pins.size() > 1 || map.cones.empty()) return;
  const ProgressMonitor::Stage stage(monitor_, "repair");
  const ComponentTask automatic = with_automatic_angles(map);
  Options plain = options_;
  plain.prescription = PrescriptionRule::least_distortion;
  plain.mode = Mode::conformal;
  std::vector<Finding> unsaid;
  ComponentSystem system(system_.surface(), automatic.cones, options_.factorization);
  const ComponentMap start = Mapping(system, automatic, plain, monitor_).best(unsaid);
  report_->iterations += start.repair.iterations;
  if (start.validity.defects() > 0 || start.curvature.needs_no_cut != map.curvature.needs_no_cut) return;
  const FoundMap unreached = found;
  double reached = approach_from(start, system, automatic.cones, found);
  // The fatter the triangles, the farther it comes, but the more stretch the map has.
  for (const double margin : fat_margins) {
    if (reached == 1 || task_.cones.rotation_order > 0) return;
    const Geometry fat = mollified(system_.mesh(), system_.geometry(), margin);
    ComponentSystem fat_system({system_.mesh(), fat}, automatic.cones, options_.factorization);
    FoundMap other = unreached;
    const double farther = approach_from(start, fat_system, automatic.cones, other);
    if (!(farther > reached)) continue;
    repair_on(system_, task_).smooth(other.map);
    reached = farther;
    found = std::move(other);
  }
}

ComponentTask Mapping::with_automatic_angles(const ComponentMap& map) const {
  ComponentTask out = task_;
  out.cones.vertices = map.cones;
  for (const Index v : task_.cones.vertices) {
    if (system_.mesh().loop_of_vertex[v] != none) out.cones.vertices.push_back(v);
  }
  out.cones.angles.assign(out.cones.vertices.size(), std::nullopt);
  out.cones.rotation_order = 0;
  out.cones.holes = Holes::as_given;
  for (std::size_t loop = 0; loop < map.curvature.needs_no_cut.size(); ++loop) {
    if (map.curvature.needs_no_cut[loop]) out.cones.loop_turning[loop] = once_around_a_hole;
  }
  return out;
}

double Mapping::approach_from(const ComponentMap& start, ComponentSystem& system, const ComponentCones& cones,
                              FoundMap& found) {
  ComponentMap& map = found.map;
  // Either map may be of fatter triangles, whose metric and cuts are others.
  const Curvature begin = metric_of(system, cones, start.curvature);
  const Curvature end = task_.cones.rotation_order > 0 ? map.curvature : metric_of(system, cones, map.curvature);
  return repair_on(system, task_).continue_from(start, {begin, end}, map, found.findings);
}

void Mapping::straighten(ComponentMap& map) {
  ComponentRepair repair = repair_on(system_, task_);
  if (!repair.may_straighten(map)) return;
  map.natural_l2 = l2_of(map);
  std::optional<ComponentMap> found;
  if (std::optional<ComponentMap> turned = with_quarter_turns(map)) {
    turned->natural_l2 = map.natural_l2;
    found = repair.straightened(*turned);
  }
  if (!found) found = repair.straightened(map);
  if (found) map = std::move(*found);
}

void Mapping::straighten_for_lattice(ComponentMap& map) {
  ComponentRepair repair = repair_on(system_, task_);
  straighten_islands(system_.surface(), SideKinds::with_creases, {options_.stretch, task_.importance}, repair.counter(),
                     map);
}

std::optional<ComponentMap> Mapping::with_quarter_turns(const ComponentMap& map) {
  const HalfedgeMesh& mesh = system_.mesh();
  constexpr double nearly = 3 * M_PI / 180, exactly = 1e-9;
  if (!map.cones.empty() || mesh.genus > 0 || mesh.boundary_loops.size() < 2) return std::nullopt;
  Eigen::VectorXd turning = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.boundary_loops.size()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none) turning[mesh.loop_of_vertex[v]] += map.curvature.at_vertex[v];
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
    ComponentMap out = Mapping(system_, rounded, plain, monitor_).best(unsaid);
    if (repair_on(system_, task_).may_straighten(out)) return out;
  } catch (const Error& error) {
    if (error.code() != Code::loop_turning && error.code() != Code::solver_failed) throw;
  }
  return std::nullopt;
}

}  // namespace

ComponentMap map_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                           std::vector<Finding>& findings, ProgressMonitor& monitor) {
  return Mapping(system, task, options, monitor).best(findings);
}

ComponentMap attempt_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                               std::vector<Finding>& findings, ProgressMonitor& monitor) {
  return Mapping(system, task, options, monitor).first(findings);
}

}  // namespace lsgp
