// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/crease_borders.hpp"

#include <cmath>
#include <set>
#include <utility>

#include "assembly/vertex_pairs.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "creases/crease_borders.hpp"
#include "creases/rounds.hpp"
#include "cut/cut_cost.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/noise.hpp"
#include "pipeline/components.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"

namespace lsgp {

VertexPairs crease_borders(const Surface& surface, const std::vector<Index>& cones, const CreaseOptions& options,
                           const Progress& progress) try {
  if (!(options.angle > 0 && options.angle <= M_PI) || options.most_corners < 0) {
    throw Error(Code::wrong_parameter,
                concat("Creases begin at an angle of ", options.angle, " radians and more than ", options.most_corners,
                       " corners. Give an angle above 0, at most pi, and a number of corners that is not negative."));
  }
  if (!(options.least_share >= 0 && options.least_share <= 1)) {
    throw Error(Code::wrong_parameter, concat("Creases are to carry ", options.least_share,
                                              " of the curvature of a component. Give a share from 0 to 1."));
  }
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_connectivity(surface);
  require_vertices(surface, options.sharp, "sharp edges");
  std::set<std::pair<Index, Index>> sharp;
  for (Index i = 0; i < options.sharp.rows(); ++i) sharp.insert(std::minmax(options.sharp(i, 0), options.sharp(i, 1)));
  const Cones given{cones, Array<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  Surface in_space = surface;  // creases are of the shape, whatever its metric
  in_space.scale.resize(0);
  const Work work = prepare({in_space, given, Options{}}, findings);
  const PerComponent<Component>& components = work.topology.components;
  Array<Index> edges;
  for_each_component(components, findings, monitor, [&](std::size_t i) {
    const Component& component = components[i];
    const HalfedgeMesh& mesh = component.mesh;
    if (!component.orientable || work.tasks[i].is_marked(mesh)) return;
    const Geometry geometry = require_geometry(component, findings);
    const Shape shape({mesh, geometry});
    const Eigen::VectorXd bend = bends(shape.surface().mesh);
    PerHalfedge<char> crease(mesh.halfedge_count(), 0);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      // Once for both sides: on folded triangles they may disagree about which way the surface bends.
      if (!may_cut(mesh, h) || h > mesh.twin[h]) continue;
      const Index a = component.source_vertex[mesh.origin(h)], b = component.source_vertex[mesh.target(h)];
      crease[h] = crease[mesh.twin[h]] = (bend[h] >= options.angle && !is_round(shape.surface().mesh, bend, h)) ||
                                         (!sharp.empty() && sharp.count(std::minmax(a, b)) > 0);
    }
    const PerHalfedge<char> open = find_crease_borders(shape.surface(), crease, bend, options);
    append_ends(component, open, edges);
  });
  monitor.advance(1);
  return to_vertex_pairs(edges);
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
