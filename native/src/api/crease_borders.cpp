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

namespace {

using SharpEdges = std::set<std::pair<Index, Index>>;  // the caller's vertices, the lower one first

void require_valid(const CreaseOptions& options) {
  if (!(options.angle > 0 && options.angle <= M_PI) || options.most_corners < 0) {
    throw Error(Code::wrong_parameter,
                concat("Creases begin at an angle of ", options.angle, " radians and more than ", options.most_corners,
                       " corners. Give an angle above 0, at most pi, and a number of corners that is not negative."));
  }
  if (!(options.least_share >= 0 && options.least_share <= 1)) {
    throw Error(Code::wrong_parameter, concat("Creases are to carry ", options.least_share,
                                              " of the curvature of a component. Give a share from 0 to 1."));
  }
}

SharpEdges sharp_edges(const CreaseOptions& options) {
  SharpEdges out;
  for (Index i = 0; i < options.sharp.rows(); ++i) out.insert(std::minmax(options.sharp(i, 0), options.sharp(i, 1)));
  return out;
}

// mesh: of the component, or its shape.
PerHalfedge<char> find_creases(const Component& component, const HalfedgeMesh& mesh, const Eigen::VectorXd& bend,
                               double angle, const SharpEdges& sharp) {
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    // Once for both sides: on folded triangles they may disagree about which way the surface bends.
    if (!may_cut(mesh, h) || h > mesh.twin[h]) continue;
    const Index a = component.source_vertex[mesh.origin(h)], b = component.source_vertex[mesh.target(h)];
    out[h] = out[mesh.twin[h]] =
        (bend[h] >= angle && !is_round(mesh, bend, h)) || (!sharp.empty() && sharp.count(std::minmax(a, b)) > 0);
  }
  return out;
}

}  // namespace

std::vector<VertexPairs> crease_borders_by(const Surface& surface, const std::vector<Index>& cones,
                                           const std::vector<CreaseOptions>& options, const Progress& progress) try {
  for (const CreaseOptions& one : options) require_valid(one);
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_connectivity(surface);
  Array<SharpEdges> sharp;
  for (const CreaseOptions& one : options) {
    require_vertices(surface, one.sharp, "sharp edges");
    sharp.push_back(sharp_edges(one));
  }
  const Cones given{cones, Array<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  Surface in_space = surface;  // creases are of the shape, whatever its metric
  in_space.scale.resize(0);
  const Work work = prepare({in_space, given, Options{}}, findings);
  const PerComponent<Component>& components = work.topology.components;
  Array<Array<Index>> edges(options.size());
  for_each_component(components, findings, monitor, [&](std::size_t i) {
    const Component& component = components[i];
    if (!component.orientable || work.tasks[i].is_marked(component.mesh)) return;
    const Geometry geometry = require_geometry(component, findings);
    const Shape shape({component.mesh, geometry});
    const MetricMesh on = shape.surface();
    const Eigen::VectorXd bend = bends(on.mesh);
    for (std::size_t k = 0; k < options.size(); ++k) {
      const PerHalfedge<char> crease = find_creases(component, on.mesh, bend, options[k].angle, sharp[k]);
      append_ends(component, find_crease_borders(on, crease, bend, options[k]), edges[k]);
    }
  });
  monitor.advance(1);
  std::vector<VertexPairs> out;
  for (const Array<Index>& ends : edges) out.push_back(to_vertex_pairs(ends));
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

VertexPairs crease_borders(const Surface& surface, const std::vector<Index>& cones, const CreaseOptions& options,
                           const Progress& progress) {
  return crease_borders_by(surface, cones, {options}, progress).front();
}

}  // namespace lsgp
