// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/map_trial.hpp"

#include <numeric>
#include <utility>

#include "pipeline/mapping.hpp"
#include "solvers/linear_algebra_counter.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// More than the rounding error where a layout shrinks much.
bool is_visible(const SeamQuality& seams) {
  constexpr double visible = 1e-5;  // of an edge's length, radians, and of the layout
  return seams.sister_ratio_max > 1 + visible || seams.rotation_residual > visible ||
         seams.translation_residual > visible;
}

double measured_l2(const HalfedgeMesh& mesh, const Eigen::VectorXcd& corners) {
  Surface surface;
  surface.positions = mesh.positions;
  surface.scale = mesh.scale;
  surface.triangles = mesh.triangles;
  CornerUv uv(corners.size(), 2);
  uv << corners.real(), corners.imag();
  Array<Index> all(mesh.triangle_count());
  std::iota(all.begin(), all.end(), 0);
  return measure_triangles(surface, uv, all).l2_stretch;
}

// The squared L2 stretch of each triangle minus 1, weighted by area and distributed to its corners.
Eigen::VectorXd stretch_at_vertices(const MetricMesh& surface, const ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Jacobians jacobians = measure_jacobians(surface, map.cut_mesh, map.position);
  const Eigen::ArrayXd square = jacobians.f_z.array().abs2(), sheared = jacobians.f_zbar.array().abs2();
  const double grown = (geometry.area.array() * (square - sheared)).sum() / geometry.total_area;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const double growth = square[f] - sheared[f];  // of area
    const double stretch = grown * (square[f] + sheared[f]) / (growth * growth) - 1;
    for (int c = 0; c < 3; ++c) out[mesh.triangles(f, c)] += stretch * geometry.area[f] / (3 * geometry.total_area);
  }
  return out;
}

}  // namespace

std::optional<ComponentMap> MapTrial::map(const ComponentCones& cones, Repairs repairs) {
  const LinearAlgebraCounter apart;
  Options options;
  options.prescription = PrescriptionRule::manual;
  ComponentTask task;
  task.cones = cones;
  std::vector<Finding> unsaid;
  ++made_;
  try {
    ComponentSystem& system = system_.of({mesh_, geometry_}, cones);
    return repairs == Repairs::easy ? attempt_component(system, task, options, unsaid, monitor_)
                                    : map_component(system, task, options, unsaid, monitor_);
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return std::nullopt;
  }
}

TriedMap MapTrial::make(const ComponentCones& cones, Repairs repairs) {
  std::optional<ComponentMap> made = map(cones, repairs);
  TriedMap out;
  if (made) out = measured(std::move(*made), cones);
  out.is_repaired = repairs == Repairs::all;
  return out;
}

std::optional<Eigen::VectorXcd> MapTrial::corners_of_map(const ComponentCones& cones) {
  const std::optional<ComponentMap> made = map(cones, Repairs::easy);
  if (!made) return std::nullopt;
  return at_corners(made->cut_mesh, made->position);
}

TriedMap MapTrial::measured(ComponentMap map, const ComponentCones& cones) const {
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  check_seams(mesh_, corners, map);
  TriedMap out;
  out.failed = false;
  out.holes = map.holes;
  out.flipped = static_cast<Index>(map.validity.flipped.size());
  out.wrong_angles = static_cast<Index>(map.validity.wrong_angle_sums.size());
  if (is_visible(map.seams)) out.inexact_seams = static_cast<Index>(map.inexact_seams.size());
  out.curvature.resize(static_cast<Eigen::Index>(cones.vertices.size()));
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    out.curvature[static_cast<Eigen::Index>(i)] = map.curvature.at_vertex[cones.vertices[i]];
  }
  if (out.flipped > 0 || out.is_off()) return out;
  out.l2 = measured_l2(mesh_, corners);
  out.stretch = stretch_at_vertices({mesh_, geometry_}, map);
  return out;
}

}  // namespace lsgp
