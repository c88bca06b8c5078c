// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/thread_team.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/said_once.hpp"
#include "pipeline/wording.hpp"
#include "prescription/component_system.hpp"

namespace lsgp {

Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options,
                                 const Progress& progress) try {
  Prescription out;
  const ThreadCount threads(options.threads);
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  const Work work = prepare({surface, cones, options}, out.warnings);
  const PerComponent<Component>& components = work.topology.components;
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  PerVertex<double> angle(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0;
  for_each_component(components, out.warnings, monitor, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    const Geometry geometry = require_geometry(component, out.warnings);
    std::vector<Finding> findings;
    ComponentSystem system({component.mesh, geometry}, task.cones, options.factorization);
    const Curvature curvature = prescribe(system, task.cones, options.prescription, findings);
    if (options.prescription == PrescriptionRule::manual) {
      require_possible({component.mesh, geometry}, task.cones, curvature.log_scale);
    }
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
  monitor.advance(1);
  say_once(out.warnings);
  out.predicted_l2 = std::sqrt(stretched_area / total_area);
  for (const Index v : cones.vertices) {
    if (std::isnan(angle[v])) continue;
    out.cones.push_back(v);
    out.cone_angles.push_back(angle[v]);
  }
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
