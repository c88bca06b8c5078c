// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <utility>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "creases/features.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/wording.hpp"
#include "placement/feature_cones.hpp"

namespace lsgp {

namespace {

// The features of closed components, as edges of the caller's surface.
Array<Index> features_of(const Work& work, std::vector<Finding>& findings) {
  Array<Index> out;
  for_each_component(work.topology.components, findings, [&](std::size_t i) {
    const Component& component = work.topology.components[i];
    const HalfedgeMesh& mesh = component.mesh;
    if (!component.orientable || !mesh.closed()) return;
    const Geometry geometry = require_geometry(component, findings);
    const PerHalfedge<char> feature = find_features({mesh, geometry});
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (!feature[h] || mesh.twin[h] < h) continue;
      out.push_back(component.source_vertex[mesh.origin(h)]);
      out.push_back(component.source_vertex[mesh.target(h)]);
    }
  });
  return out;
}

}  // namespace

Cones feature_cones(const Surface& surface, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  std::vector<Finding> findings;
  const Array<Index> edges = features_of(prepare({surface, {}, Options{}}, findings), findings);
  Cones out;
  if (edges.empty()) return out;
  Surface opened = surface;
  opened.seams.resize(0, 2);
  const Eigen::Index before = opened.borders.rows(), count = ssize(edges) / 2;
  opened.borders.conservativeResize(before + count, 2);
  for (Eigen::Index i = 0; i < count; ++i) opened.borders.row(before + i) << edges[2 * i], edges[2 * i + 1];
  const Work patches = prepare({opened, {}, Options{}}, findings);
  std::map<Index, Index> angle;  // in quarter turns
  bool is_possible = true;
  for_each_component(patches.topology.components, findings, monitor, [&](std::size_t i) {
    const Component& patch = patches.topology.components[i];
    if (!patch.orientable || patch.mesh.closed()) return;
    const Geometry geometry = require_geometry(patch, findings);
    const std::optional<PatchAngles> found = round_patch({patch.mesh, geometry});
    is_possible = is_possible && found;
    if (!found) return;
    for (Index v = 0; v < patch.mesh.vertex_count(); ++v) {
      if (found->at_border[v] > 0) angle[patch.source_vertex[v]] += found->at_border[v];
    }
    for (const auto& [v, curvature] : found->curvature) angle[patch.source_vertex[v]] = 4 - curvature;
  });
  monitor.advance(1);
  if (!is_possible) return out;
  for (const auto& [v, quarters] : angle) {
    if (quarters == 4) continue;
    out.vertices.push_back(v);
    out.angles.emplace_back(quarters * M_PI / 2);
  }
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
