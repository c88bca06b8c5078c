// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/component_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/mapping.hpp"

namespace lsgp {

void check_seams(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map) {
  map.seams = measure_seams(mesh, map.cut_graph, corners, map.rotation ? &*map.rotation : nullptr,
                            map.rotation ? &map.inexact_seams : nullptr);
}

void check_triangles(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map) {
  map.validity = check_map(mesh, corners, map.curvature.at_vertex, map.curvature.is_free);
  if (map.rotation) return;
  map.validity.wrong_angle_sums.clear();  // without transitions all angles are free
  map.validity.inexact_angles.clear();
}

void check_positions(const HalfedgeMesh& mesh, ComponentMap& map) {
  if (!map.position.allFinite()) {
    throw Error(Code::solver_failed,
                "The unfolding returned values that are not finite. Clean the mesh (merge by distance, "
                "dissolve degenerate faces) and try again.");
  }
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  map.uv_area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) map.uv_area += doubled_area(corners, f) / 2;
  check_triangles(mesh, corners, map);
}

namespace {

// Ranges of the automatic angles: wide ones distort least but may leave turns with neighbouring vertices; a map of
// angles up to 2 pi that has no flips has the right angles too.
constexpr AngleRange angle_ranges[]{widest_angles, {M_PI / 2, 2.5 * M_PI}, {M_PI / 2, 2 * M_PI, false}};

bool any_given(const ComponentCones& cones) {
  return std::any_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

bool all_given(const ComponentCones& cones) {
  return std::all_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

bool closes_holes(const ComponentMap& map) {
  const PerLoop<char>& closed = map.curvature.needs_no_cut;
  return std::find(closed.begin(), closed.end(), 1) != closed.end();
}

struct FoundMap {
  ComponentMap map;
  std::vector<Finding> findings;
};

// Tries angles and geometries, local repairs first; returns the map with the fewest defects.
FoundMap find_valid_map(ComponentSystem& system, const ComponentTask& task, const Options& options,
                        ProgressMonitor& monitor, std::optional<RepairReport>& repair) {
  constexpr double fat_margin = 0.2;
  const bool persists = repairs(options);
  const bool is_free = persists && task.cones.symmetry == 0 &&
                       (options.prescription == PrescriptionRule::least_distortion ||
                        (options.prescription == PrescriptionRule::manual && !all_given(task.cones)));
  std::optional<FoundMap> best;
  const HalfedgeMesh& mesh = system.mesh();
  std::optional<Geometry> fat;
  std::optional<ComponentSystem> fat_system;
  for (const Effort effort : {Effort::local, Effort::global}) {
    // Local repairs are first tried on the surface itself; hard cases are easier on fat triangles.
    for (const bool is_fat : {effort == Effort::global, effort == Effort::local}) {
      if (is_fat && !fat) {
        fat = mollified(mesh, system.geometry(), fat_margin);
        fat_system.emplace(mesh, *fat, task.cones, options.factorization);
      }
      Mapping mapping(is_fat ? *fat_system : system, task, options, monitor, repair);
      for (std::size_t i = 0; i < (is_free ? std::size(angle_ranges) : 1); ++i) {
        ComponentCones cones = task.cones;
        if (is_free) cones.range = angle_ranges[i];
        FoundMap found;
        try {
          found.map = mapping.attempt(cones, effort, found.findings);
        } catch (const Error& error) {
          if (!best || error.code() != Code::solver_failed) throw;
          continue;
        }
        const std::size_t defects = found.map.validity.defects();
        if (!best || defects < best->map.validity.defects()) {
          if (is_fat && defects == 0) Mapping(system, task, options, monitor, repair).smooth(found.map);
          best = std::move(found);
        }
        if (best->map.validity.defects() == 0) return std::move(*best);
        // A valid map would have been proof that its angles are possible.
        if (effort == Effort::local && !is_fat && options.prescription == PrescriptionRule::manual) {
          require_possible(mesh, system.geometry(), task.cones);
        }
        if (!persists) return std::move(*best);
      }
    }
  }
  return std::move(*best);
}

}  // namespace

ComponentMap attempt_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                               std::vector<Finding>& findings, ProgressMonitor& monitor) {
  std::optional<RepairReport> repair;
  ComponentMap map = Mapping(system, task, options, monitor, repair).attempt(task.cones, Effort::local, findings);
  map.repair = repair.value_or(RepairReport{});
  return map;
}

ComponentMap map_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                           std::vector<Finding>& findings, ProgressMonitor& monitor) {
  std::optional<RepairReport> repair;
  auto [map, found] = find_valid_map(system, task, options, monitor, repair);
  const bool chooses_holes = task.cones.holes == Holes::where_cheap || task.cones.holes == Holes::all;
  if (map.validity.defects() > 0 && repairs(options) && closes_holes(map) && chooses_holes) {
    ComponentTask opened = task;
    opened.cones.holes = Holes::as_they_are;
    FoundMap other = find_valid_map(system, opened, options, monitor, repair);
    if (other.map.validity.defects() < map.validity.defects()) {
      map = std::move(other.map);
      found = std::move(other.findings);
    }
  }
  Mapping mapping(system, task, options, monitor, repair);
  if (map.validity.defects() > 0 && repairs(options) && (any_given(task.cones) || task.cones.symmetry > 0)) {
    mapping.approach_angles(map, found);
  }
  if (options.mode == Mode::low_stretch && options.stretch > 0 && map.validity.defects() == 0) {
    mapping.relax(map);
    mapping.straighten(map);
  }
  map.repair = repair.value_or(RepairReport{});
  findings.insert(findings.end(), found.begin(), found.end());
  return map;
}

}  // namespace lsgp
