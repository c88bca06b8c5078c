// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs but for cone placement and measuring; every component is worked on for itself.
#include <cmath>
#include <limits>

#include "assembly.hpp"
#include "component_map.hpp"
#include "components.hpp"
#include "lsgp/lsgp.hpp"
#include "monitor.hpp"
#include "seamless.hpp"
#include "text.hpp"

namespace lsgp {

namespace {

void report_border_cones(const Component& component, const std::vector<Index>& border_cones,
                         std::vector<Finding>& findings) {
  if (border_cones.empty()) return;
  findings.push_back(
      {Code::cone_on_boundary,
       concat(count(border_cones.size(), "cone lies", "cones lie"),
              " on an open border, where angles are free anyway; nothing was prescribed there. Give it an "
              "angle to make it a corner."),
       in_source(component, {ElementKind::vertices, border_cones})});
}

void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to) {
  for (Finding& finding : from) {
    to.push_back({finding.code, std::move(finding.message), in_source(component, std::move(finding.elements))});
  }
}

}  // namespace

Result parameterize(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    const Progress& progress) {
  Result result;
  Monitor monitor(progress, result.stage_seconds);
  Work work = [&] {
    const Monitor::Stage stage(monitor, "topology");
    return prepare(surface, cones, options, result.warnings, pins);
  }();
  const std::vector<Component>& components = work.topology.components;
  if (options.seamless) require_valid(*options.seamless, options, pins);
  constexpr double share_of_rounding = 0.5;
  const double share_of_maps = options.seamless ? 1 - share_of_rounding : 1;
  Index triangles_before = 0;
  std::vector<std::optional<Geometry>> geometries(components.size());
  std::vector<std::optional<ComponentMap>> maps(components.size());
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    std::vector<Finding> findings;
    const auto share_up_to = [&](Index count) { return share_of_maps * count / surface.triangles.rows(); };
    const double begin = share_up_to(triangles_before);
    triangles_before += component.mesh.triangle_count();
    const Monitor::Part part(monitor, begin, share_up_to(triangles_before));
    monitor.advance(0);
    {
      const Monitor::Stage stage(monitor, "geometry");
      geometries[i] = require_geometry(component, result.warnings);
    }
    ComponentSystem system(component.mesh, *geometries[i], task.cones, options.factorization);
    maps[i] = map_component(system, task, options, findings, monitor);
    result.repair.flipped_before += maps[i]->repair.flipped_before;
    result.repair.wrong_angle_sums_before += maps[i]->repair.wrong_angle_sums_before;
    result.repair.iterations += maps[i]->repair.iterations;
    if (options.seamless) require_quantizable(component.mesh, *maps[i]);
    report_border_cones(component, task.border_cones, result.warnings);
    move_findings(component, findings, result.warnings);
  });
  if (options.seamless) {
    const Monitor::Stage stage(monitor, "quantize");
    const Monitor::Part part(monitor, share_of_maps, 1);
    monitor.advance(0);
    std::vector<SeamlessPart> parts;
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (maps[i]) parts.push_back({&components[i], &*geometries[i], &work.tasks[i], &*maps[i]});
    }
    result.seamless = make_seamless(options, work.unit_scale, parts, result.warnings, monitor);
  }
  const Monitor::Stage stage(monitor, "layout");
  Assembly assembly(surface, components, options, monitor, result);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (maps[i]) assembly.add(i, work.tasks[i].cones, *geometries[i], std::move(*maps[i]));
  }
  assembly.finish(cones, work.topology.duplicates);
  monitor.advance(1);
  return result;
}

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
