// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/features.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr double sharp = 40 * M_PI / 180;  // between the normals at a crease
constexpr double least_on_features = 0.8;  // of the curvature of a hard surface
constexpr double least_curvature = 0.1;    // radians: below, there is nothing that features could carry

}  // namespace

PerHalfedge<char> find_features(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  PerVertex<char> has_feature(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !(bend_at(mesh, h) >= sharp)) continue;
    out[h] = 1;
    has_feature[mesh.origin(h)] = 1;
  }
  double all = 0, on_features = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none) continue;
    const double curvature = std::abs(surface.geometry.angle_defect[v]);
    all += curvature;
    if (has_feature[v]) on_features += curvature;
  }
  if (!(all > least_curvature && on_features >= least_on_features * all)) std::fill(out.begin(), out.end(), 0);
  return out;
}

}  // namespace lsgp
