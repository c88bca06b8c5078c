// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/directed_placement.hpp"

#include <algorithm>
#include <limits>

#include "pipeline/components.hpp"
#include "pipeline/directed_borders.hpp"
#include "placement/map_trial.hpp"
#include "plane/point_lattice.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

namespace {

constexpr double most_stretch = 1.2;  // that is accepted for straight courses

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

}  // namespace lsgp
