// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/directed_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pipeline/components.hpp"
#include "pipeline/directed_borders.hpp"
#include "placement/map_trial.hpp"
#include "plane/point_lattice.hpp"
#include "prescription/stroke_fit.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

namespace {

constexpr double most_stretch = 1.2;  // that is accepted for straight courses

// The cones with automatic angles that are chosen for strokes; those of no curvature are left out.
ComponentCones cones_for_strokes(const PlacementTask& task, const TextureDirections& strokes,
                                 const PlacementOptions& options, const PlacedCones& usual) {
  constexpr double exactly = 1e-9;  // radians
  ComponentCones asked = usual.cones;
  std::fill(asked.angles.begin(), asked.angles.end(), std::nullopt);
  std::copy(task.existing.angles.begin(), task.existing.angles.end(), asked.angles.begin());
  asked.rotation_order = options.lattice ? rotation_order(*options.lattice) : 0;
  ComponentSystem system(task, asked, Factorization::automatic);
  std::vector<Finding> unsaid;
  const Curvature curvature = prescribe(system, asked, PrescriptionRule::manual, unsaid, &strokes);
  ComponentCones out = usual.cones;
  out.vertices.clear();
  out.angles.clear();
  for (std::size_t i = 0; i < asked.vertices.size(); ++i) {
    const Index v = asked.vertices[i];
    const bool is_existing = i < task.existing.vertices.size();
    if (!is_existing && std::abs(curvature.at_vertex[v]) < exactly) continue;
    out.vertices.push_back(v);
    out.angles.push_back(task.mesh.flat_angle(v) - curvature.at_vertex[v]);
  }
  return out;
}

}  // namespace

std::optional<PlacedCones> place_beside_directions(const PlacementTask& task, const Positions& directions,
                                                   const PlacementOptions& options, const PlacedCones& usual,
                                                   ProgressMonitor& monitor) {
  const int turns = rotation_order(*options.lattice);
  PerVertex<char> allowed = runs_straight_around(task.mesh, directions, turns);
  for (Index v = 0; v < task.mesh.vertex_count(); ++v) allowed[v] = task.allowed[v] && !allowed[v];
  ComponentCones existing = task.existing;
  const bool turned = let_borders_run_along(task.mesh, directions, turns, std::nullopt, existing);
  if (!turned && allowed == task.allowed) return std::nullopt;
  const TextureDirections wanted = directions_in_triangles(task.mesh, directions);
  MapTrial trial(task, monitor);
  const auto misalignment = [&](const PlacedCones& placed) {
    const auto corners = trial.corners_of_map(placed.cones);
    return corners ? misalignment_on_lattice(wanted, *corners, turns) : std::numeric_limits<double>::infinity();
  };
  // The fewest cones necessary, since there is little room for them.
  PlacementOptions generous = options;
  generous.target = std::max(options.target, most_stretch);
  try {
    std::vector<Finding> unsaid;
    PlacedCones found = place_component({task, existing, allowed, task.mirrored}, generous, unsaid, monitor);
    if (!found.reached) return std::nullopt;
    if (!straightens_courses(misalignment(found), misalignment(usual))) return std::nullopt;
    found.maps += trial.made();
    return found;
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return std::nullopt;
  }
}

std::optional<PlacedCones> turn_toward_strokes(const PlacementTask& task, const Positions& directions,
                                               const PlacementOptions& options, const PlacedCones& usual,
                                               ProgressMonitor& monitor) {
  const TextureDirections strokes = directions_in_triangles(task.mesh, directions);
  if (!options.follow_strokes || usual.cones.vertices.empty() || !are_strokes(strokes, task.geometry))
    return std::nullopt;
  const int turns = options.lattice ? rotation_order(*options.lattice) : 1;
  MapTrial trial(task, monitor);
  const auto missed = [&](const ComponentCones& cones) {
    const auto corners = trial.corners_of_map(cones);
    return corners ? misalignment_on_lattice(strokes, *corners, turns) : std::numeric_limits<double>::infinity();
  };
  try {
    PlacedCones out;
    out.cones = cones_for_strokes(task, strokes, options, usual);
    if (out.cones.vertices == usual.cones.vertices && out.cones.angles == usual.cones.angles) return std::nullopt;
    const double before = missed(usual.cones), after = missed(out.cones);
    const TriedMap map = trial.make(out.cones, MapTrial::Repairs::all);
    if (!map.is_valid() || !is_worth_strokes({map.l2, after}, {usual.mapped_l2, before})) return std::nullopt;
    out.system = trial.take_system(out.cones);
    std::vector<Finding> unsaid;
    out.curvature = prescribe(*out.system.get(), out.cones, PrescriptionRule::manual, unsaid);
    out.mapped_l2 = map.l2;
    out.maps = usual.maps + trial.made();
    out.missing = usual.missing;
    out.reached = usual.reached;
    return out;
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return std::nullopt;
  }
}

}  // namespace lsgp
