// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/directed_borders.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "pipeline/mapping.hpp"
#include "solvers/linear_algebra_counter.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

constexpr double most_growth = 1.2;   // of the L2 stretch, for straight courses
constexpr double most_missed = 0.12;  // radians, of courses that count as straight; half as much as before does as well
constexpr double least_gain = 0.05;   // radians

// None where there is no valid map.
std::optional<DirectedMap> attempt(const MetricMesh& surface, const ComponentTask& task, ProgressMonitor& monitor) {
  const LinearAlgebraCounter apart;
  std::vector<Finding> unsaid;
  try {
    ComponentSystem system(surface, task.cones, Factorization::automatic);
    const ComponentMap map = attempt_component(system, task, {}, unsaid, monitor);
    if (map.validity.defects() > 0) return std::nullopt;
    return DirectedMap{
        l2_stretch(surface.geometry, measure_jacobians(surface, map.cut_mesh, map.position)),
        misalignment_on_lattice(task.directions, at_corners(map.cut_mesh, map.position), task.cones.rotation_order)};
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return std::nullopt;
  }
}

}  // namespace

bool straightens_courses(double missed, double before) {
  return missed <= std::max(most_missed, before / 2) && missed < before - least_gain;
}

bool is_worth_strokes(const DirectedMap& toward, const DirectedMap& usual) {
  constexpr double most_stretch = 1.1, least = 0.01;  // times the usual one; radians
  return toward.l2 <= most_stretch * usual.l2 && toward.missed < usual.missed - least;
}

void free_stretched_borders(const MetricMesh& surface, ProgressMonitor& monitor, ComponentTask& task) {
  ComponentTask free = task;
  free.cones.loop_turning.assign(task.cones.loop_turning.size(), std::nullopt);
  const std::optional<DirectedMap> usual = attempt(surface, free, monitor);
  if (!usual) return;
  const std::optional<DirectedMap> directed = attempt(surface, task, monitor);
  const bool is_better =
      directed && directed->l2 <= most_growth * usual->l2 && straightens_courses(directed->missed, usual->missed);
  if (!is_better) task.cones.loop_turning = std::move(free.cones.loop_turning);
}

}  // namespace lsgp
