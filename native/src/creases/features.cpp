// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/features.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

CreaseCurvature::CreaseCurvature(const MetricMesh& surface, const PerVertex<char>& is_at_crease) {
  for (Index v = 0; v < surface.mesh.vertex_count(); ++v) {
    if (surface.mesh.loop_of_vertex[v] != none) continue;
    const double curvature = std::abs(surface.geometry.angle_defect[v]);
    all_ += curvature;
    all_squares_ += curvature * curvature;
    if (!is_at_crease[v]) continue;
    at_creases_ += curvature;
    squares_at_creases_ += curvature * curvature;
  }
}

bool CreaseCurvature::is_curved() const {
  constexpr double least = 0.1;  // radians
  return all_ > least;
}

double CreaseCurvature::count(double sum, double of_squares) { return std::round(sum * sum / of_squares); }

PerHalfedge<char> find_features(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  PerVertex<char> has_feature(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !(bend_at(mesh, h) >= crease_angle)) continue;
    out[h] = 1;
    has_feature[mesh.origin(h)] = 1;
  }
  if (!CreaseCurvature(surface, has_feature).is_hard()) std::fill(out.begin(), out.end(), 0);
  return out;
}

PerHalfedge<char> features_to_align(const MetricMesh& surface, bool with_creases) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), no_feature);
  if (with_creases) out = find_features(surface);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (out[h]) out[h] = crease_feature;
    if (mesh.has_features() && mesh.feature[h]) out[h] = marked_feature;
  }
  return out;
}

}  // namespace lsgp
