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

// Those of components that are closed, or end at features.
struct SurfaceFeatures {
  Array<Index> edges;            // as the caller's vertices
  PerVertex<char> is_border;     // (n)
  PerTriangle<Index> component;  // (m) with features, numbered from 0; none without
  std::size_t component_count = 0;
};

// Whether all boundaries are features, so that the angles along them are known.
bool is_enclosed(const HalfedgeMesh& mesh, const PerHalfedge<char>& feature) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none && feature[h] == no_feature) return false;
  }
  return true;
}

SurfaceFeatures features_of(const Surface& surface, bool with_creases, std::vector<Finding>& findings) {
  const Work work = prepare({surface, {}, Options{}}, findings);
  SurfaceFeatures out;
  out.is_border.assign(surface.positions.rows(), 0);
  out.component.assign(surface.triangles.rows(), none);
  for_each_component(work.topology.components, findings, [&](std::size_t i) {
    const Component& component = work.topology.components[i];
    const HalfedgeMesh& mesh = component.mesh;
    if (!component.orientable || !(mesh.closed() || mesh.has_features())) return;
    const Geometry geometry = require_geometry(component, findings);
    const PerHalfedge<char> feature = features_to_align({mesh, geometry}, with_creases && mesh.closed());
    if (!is_enclosed(mesh, feature)) return;
    const std::size_t before = out.edges.size();
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (feature[h] == no_feature || mesh.twin[h] > h) continue;
      const Index tail = component.source_vertex[mesh.origin(h)], head = component.source_vertex[mesh.target(h)];
      out.edges.insert(out.edges.end(), {tail, head});
      if (mesh.twin[h] == none) out.is_border[tail] = out.is_border[head] = 1;
    }
    if (out.edges.size() == before) return;
    for (const Index f : component.source_triangle) out.component[f] = static_cast<Index>(out.component_count);
    ++out.component_count;
  });
  return out;
}

}  // namespace

Cones feature_cones(const Surface& surface, bool with_creases, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  std::vector<Finding> findings;
  const SurfaceFeatures features = features_of(surface, with_creases, findings);
  const Array<Index>& edges = features.edges;
  Cones out;
  if (edges.empty()) return out;
  Surface opened = surface;
  opened.seams.resize(0, 2);
  const Eigen::Index before = opened.borders.rows(), count = ssize(edges) / 2;
  opened.borders.conservativeResize(before + count, 2);
  for (Eigen::Index i = 0; i < count; ++i) opened.borders.row(before + i) << edges[2 * i], edges[2 * i + 1];
  const Work patches = prepare({opened, {}, Options{}}, findings);
  Array<std::map<Index, Index>> angles(features.component_count);  // by component, in quarter turns
  Array<char> is_possible(features.component_count, 1);
  for_each_component(patches.topology.components, findings, monitor, [&](std::size_t i) {
    const Component& patch = patches.topology.components[i];
    const Index component = features.component[patch.source_triangle.front()];
    if (component == none || !patch.orientable || patch.mesh.closed()) return;
    const Geometry geometry = require_geometry(patch, findings);
    const std::optional<PatchAngles> found = round_patch({patch.mesh, geometry});
    if (!found) {
      is_possible[component] = 0;
      return;
    }
    std::map<Index, Index>& angle = angles[component];
    for (Index v = 0; v < patch.mesh.vertex_count(); ++v) {
      if (found->at_border[v] > 0) angle[patch.source_vertex[v]] += found->at_border[v];
    }
    for (const auto& [v, curvature] : found->curvature) angle[patch.source_vertex[v]] = 4 - curvature;
  });
  monitor.advance(1);
  PerVertex<char> is_cone(surface.positions.rows(), 0);  // those at which components touch have one angle
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (!is_possible[i]) continue;
    for (const auto& [v, quarters] : angles[i]) {
      if (is_cone[v] || quarters == (features.is_border[v] ? 2 : 4)) continue;
      is_cone[v] = 1;
      out.vertices.push_back(v);
      out.angles.emplace_back(quarters * M_PI / 2);
    }
  }
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp
