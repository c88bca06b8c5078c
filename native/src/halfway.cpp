// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that stop halfway: cuts alone and angles alone; every component is worked on for itself.
#include <cmath>
#include <limits>

#include "component_system.hpp"
#include "components.hpp"
#include "lsgp/lsgp.hpp"

namespace lsgp {

CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options) {
  const Cones automatic{cones, std::vector<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  const Work work = prepare(surface, automatic, options, findings);
  const std::vector<Component>& components = work.topology.components;
  CutPaths out;
  std::vector<Index> edges;
  for_each_component(components, findings, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, findings);
    const std::vector<Index> inside = inside_only(component.mesh, work.tasks[i].cones.vertices);
    for (const Cut& cut : connect_cones(component.mesh, geometry, inside, {}).cuts) {
      std::vector<Index> path{component.source_vertex[cut.tail]};
      for (const Index h : cut.halfedges) path.push_back(component.source_vertex[component.mesh.target(h)]);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) edges.insert(edges.end(), {path[k], path[k + 1]});
      out.paths.push_back(std::move(path));
    }
  });
  out.edges = Eigen::Map<VertexPairs>(edges.data(), static_cast<Eigen::Index>(edges.size() / 2), 2);
  return out;
}

Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options) {
  Prescription out;
  const Work work = prepare(surface, cones, options, out.warnings);
  const std::vector<Component>& components = work.topology.components;
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  std::vector<double> angle(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0;
  for_each_component(components, out.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    const Geometry geometry = require_geometry(component, out.warnings);
    std::vector<Finding> findings;
    ComponentSystem system(component.mesh, geometry, task.cones, Factorization::sparse);
    const Curvature curvature = prescribe(system, task.cones, options.prescription, findings);
    if (options.prescription == PrescriptionRule::manual) require_possible(component.mesh, geometry, task.cones);
    report_border_cones(component, task.border_cones, out.warnings);
    move_findings(component, findings, out.warnings);
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      out.log_scale[component.source_vertex[v]] = curvature.log_scale[v];
    }
    for (const Index v : task.cones.vertices) {
      angle[component.source_vertex[v]] = component.mesh.flat_angle(v) - curvature.at_vertex[v];
    }
    // Islands get the same area in 2D as in 3D, so their squared stretches add up by area.
    stretched_area += curvature.predicted_l2 * curvature.predicted_l2 * geometry.total_area;
    total_area += geometry.total_area;
  });
  out.predicted_l2 = std::sqrt(stretched_area / total_area);
  for (const Index v : cones.vertices) {
    if (std::isnan(angle[v])) continue;
    out.cones.push_back(v);
    out.cone_angles.push_back(angle[v]);
  }
  return out;
}

}  // namespace lsgp
