// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/features.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/union_find.hpp"
#include "mesh/noise.hpp"

namespace lsgp {

namespace {

// Sets of vertices that lie on each other, next to the size of the triangles there: intersections of solids leave them,
// and single ones have angles that say nothing.
UnionFind coincident_vertices(const HalfedgeMesh& mesh) {
  constexpr double least_length = 1e-4;  // of the triangle's longest edge
  UnionFind out(mesh.vertex_count());
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    double length[3];
    for (int c = 0; c < 3; ++c) {
      const Index h = 3 * f + c;
      length[c] = (mesh.positions.row(mesh.target(h)) - mesh.positions.row(mesh.origin(h))).norm();
    }
    const double least = least_length * *std::max_element(std::begin(length), std::end(length));
    for (int c = 0; c < 3; ++c) {
      if (length[c] < least) out.unite(mesh.origin(3 * f + c), mesh.target(3 * f + c));
    }
  }
  return out;
}

// Whether features are lines rather than noise, which is as sharp in places and ends everywhere.
bool are_lines(const HalfedgeMesh& mesh, const PerHalfedge<char>& feature) {
  constexpr double most_ends = 0.2;  // of the points of features
  UnionFind point = coincident_vertices(mesh);
  PerVertex<char> is_inside(mesh.vertex_count(), 1);
  PerVertex<Index> edges(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none) is_inside[point.find(v)] = 0;
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index from = point.find(mesh.origin(h));
    if (feature[h] && from != point.find(mesh.target(h))) ++edges[from];
  }
  double points = 0, ends = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    points += edges[v] > 0 ? 1 : 0;
    ends += edges[v] == 1 && is_inside[v] ? 1 : 0;
  }
  return ends <= most_ends * points;
}

}  // namespace

CreaseCurvature::CreaseCurvature(const MetricMesh& surface, const PerVertex<char>& is_at_crease) {
  const HalfedgeMesh& mesh = surface.mesh;
  UnionFind point = coincident_vertices(mesh);
  const Eigen::VectorXd own = defects_in_space(surface);
  PerVertex<double> defect(mesh.vertex_count(), 0);
  PerVertex<char> is_inside(mesh.vertex_count(), 1), is_crease(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Index at = point.find(v);
    defect[at] += own[v];
    if (mesh.loop_of_vertex[v] != none) is_inside[at] = 0;
    if (is_at_crease[v]) is_crease[at] = 1;
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (point.find(v) != v || !is_inside[v]) continue;
    const double curvature = std::abs(defect[v]);
    all_ += curvature;
    all_squares_ += curvature * curvature;
    if (!is_crease[v]) continue;
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
  const Shape shape(surface);
  const HalfedgeMesh& mesh = shape.surface().mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  PerVertex<char> has_feature(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !(bend_at(mesh, h) >= crease_angle)) continue;
    out[h] = 1;
    has_feature[mesh.origin(h)] = 1;
  }
  const bool is_hard = CreaseCurvature(shape.surface(), has_feature).is_hard() && are_lines(mesh, out);
  if (!is_hard) std::fill(out.begin(), out.end(), 0);
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
