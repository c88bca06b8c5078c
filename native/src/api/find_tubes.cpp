// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/vertex_pairs.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "creases/opened_tube.hpp"
#include "creases/tubes.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"

namespace lsgp {

Tubes find_tubes(const Surface& surface, const std::vector<Index>& cones, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_connectivity(surface);
  const Cones given{cones, Array<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  const Work work = prepare({surface, given, Options{}}, findings);
  const PerComponent<Component>& components = work.topology.components;
  Tubes out;
  Array<Index> borders;
  for_each_component(components, findings, monitor, [&](std::size_t i) {
    const Component& component = components[i];
    if (!component.orientable) return;
    const ComponentTask& task = work.tasks[i];
    const bool is_marked = task.is_marked(component.mesh);
    if (is_marked && (!component.mesh.is_disk() || task.is_marked_inside(component.mesh))) return;
    const Geometry geometry = require_geometry(component, findings);
    if (is_marked) {
      // All of it is a tube, which has no further ends, or nothing.
      if (girths_of_opened_tube({component.mesh, geometry}))
        out.triangles.insert(out.triangles.end(), component.source_triangle.begin(), component.source_triangle.end());
      return;
    }
    const ComponentTubes tubes = find_component_tubes({component.mesh, geometry});
    append_ends(component, tubes.is_end, borders);
    for (const Index f : tubes.triangles) out.triangles.push_back(component.source_triangle[f]);
  });
  sort_unique(out.triangles);
  out.borders = to_vertex_pairs(borders);
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
