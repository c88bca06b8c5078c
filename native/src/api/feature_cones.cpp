// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
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

struct SurfaceFeatures {
  Array<Index> edges;         // as the caller's vertices
  PerVertex<char> is_border;  // (n)
};

// Whether all boundaries are features, so that the angles along them are known.
bool is_enclosed(const HalfedgeMesh& mesh, const PerHalfedge<char>& feature) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none && feature[h] == no_feature) return false;
  }
  return true;
}

// Those of components that are closed, or end at features.
SurfaceFeatures features_of(const Work& work, bool with_creases, std::vector<Finding>& findings) {
  SurfaceFeatures out;
  for_each_component(work.topology.components, findings, [&](std::size_t i) {
    const Component& component = work.topology.components[i];
    const HalfedgeMesh& mesh = component.mesh;
    if (!component.orientable || !(mesh.closed() || mesh.has_features())) return;
    const Geometry geometry = require_geometry(component, findings);
    const PerHalfedge<char> feature = features_to_align({mesh, geometry}, with_creases && mesh.closed());
    if (!is_enclosed(mesh, feature)) return;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (feature[h] == no_feature || mesh.twin[h] > h) continue;
      const Index tail = component.source_vertex[mesh.origin(h)], head = component.source_vertex[mesh.target(h)];
      out.edges.insert(out.edges.end(), {tail, head});
      if (mesh.twin[h] != none) continue;
      const auto least_size = static_cast<std::size_t>(std::max(tail, head)) + 1;
      out.is_border.resize(std::max(out.is_border.size(), least_size), 0);
      out.is_border[tail] = out.is_border[head] = 1;
    }
  });
  return out;
}

}  // namespace

Cones feature_cones(const Surface& surface, bool with_creases, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  std::vector<Finding> findings;
  SurfaceFeatures features = features_of(prepare({surface, {}, Options{}}, findings), with_creases, findings);
  const Array<Index>& edges = features.edges;
  features.is_border.resize(static_cast<std::size_t>(surface.positions.rows()), 0);
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
    if (quarters == (features.is_border[v] ? 2 : 4)) continue;
    out.vertices.push_back(v);
    out.angles.emplace_back(quarters * M_PI / 2);
  }
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
