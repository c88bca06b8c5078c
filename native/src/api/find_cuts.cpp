// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>
#include <utility>

#include "assembly/vertex_pairs.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/wording.hpp"
#include "prescription/component_system.hpp"

namespace lsgp {

CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options,
                   const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  const Cones automatic{cones, Array<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  const Work work = prepare({surface, automatic, options}, findings);
  const PerComponent<Component>& components = work.topology.components;
  CutPaths out;
  Array<Index> edges;
  for_each_component(components, findings, monitor, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, findings);
    const Array<Index> inside = inside_only(component.mesh, work.tasks[i].cones.vertices);
    for (const Cut& cut : connect_cones({component.mesh, geometry}, inside, {}).cuts) {
      Array<Index> path{component.source_vertex[cut.tail]};
      for (const Index h : cut.halfedges) path.push_back(component.source_vertex[component.mesh.target(h)]);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) edges.insert(edges.end(), {path[k], path[k + 1]});
      out.paths.push_back(std::move(path));
    }
  });
  monitor.advance(1);
  out.edges = to_vertex_pairs(edges);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
