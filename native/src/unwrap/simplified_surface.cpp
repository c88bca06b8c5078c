// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/simplified_surface.hpp"

#include <utility>

#include "measures/made_map.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/vertex_costs.hpp"

namespace lsgp {

namespace {

ThinnedSurface thinned(const Surface& whole, const VertexPairs& kept, Index triangles) {
  const EdgeTable edges(whole, PerTriangle<char>(whole.triangles.rows(), 0));
  const PerHalfedge<Index> twin = find_twins(whole, edges);
  Surface fixed;
  fixed.positions = whole.positions;
  fixed.triangles = whole.triangles;
  fixed.seams = whole.seams;
  fixed.borders = joined(whole.borders, kept);
  fixed.features = whole.features;
  return thin(fixed, edges, twin, triangles);
}

}  // namespace

SimplifiedSurface::SimplifiedSurface(const Surface& whole, const VertexPairs& kept, Index triangles)
    : thinned_(thinned(whole, kept, triangles)), left_(vertices_left(thinned_)) {
  triangle_of_whole_.resize(whole.triangles.rows());
  for (Index f = 0; f < whole.triangles.rows(); ++f)
    triangle_of_whole_[f] = triangle_left(whole.triangles, thinned_, f);
  const auto of_left = [&](const auto& values) {
    Eigen::VectorXd out(values.size() == 0 ? 0 : ssize(left_.vertex));
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = values[left_.vertex[i]];
    return out;
  };
  surface_.positions.resize(ssize(left_.vertex), 3);
  for (Index i = 0; i < ssize(left_.vertex); ++i) surface_.positions.row(i) = whole.positions.row(left_.vertex[i]);
  surface_.triangles = thinned_.triangles;
  for (Index& v : surface_.triangles.reshaped()) v = left_.number[v];
  surface_.seams = from_whole(whole.seams);
  surface_.borders = from_whole(whole.borders);
  surface_.features = from_whole(whole.features);
  surface_.may_collapse = whole.may_collapse;
  surface_.importance = of_left(whole.importance);
  const Eigen::VectorXd cost = of_left(costs_at_vertices(whole));
  if (cost.size() > 0) take_costs(cost, surface_);
}

VertexPairs SimplifiedSurface::from_whole(VertexPairs pairs) const {
  for (Index& v : pairs.reshaped()) v = left_.number[v];
  return pairs;
}

VertexPairs SimplifiedSurface::on_whole(VertexPairs pairs) const {
  for (Index& v : pairs.reshaped()) v = left_.vertex[v];
  return pairs;
}

CompletedCones SimplifiedSurface::on_whole(CompletedCones cones) const {
  for (Index& v : cones.cones.vertices) v = left_.vertex[v];
  if (!cones.placement) return cones;
  Placement& placement = *cones.placement;
  for (Index& v : placement.cones) v = left_.vertex[v];
  placement.log_scale = on_whole(placement.log_scale);
  placement.warnings = on_whole(std::move(placement.warnings));
  return cones;
}

Eigen::VectorXd SimplifiedSurface::on_whole(const Eigen::VectorXd& at_vertices) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(ssize(left_.number));
  if (at_vertices.size() == 0) return out;
  for (Index v = 0; v < ssize(left_.number); ++v) {
    const SurfacePlace& place = thinned_.place[v];
    for (int c = 0; c < 3 && place.triangle != none; ++c) {
      if (place.share[c] > 0) out[v] += place.share[c] * at_vertices[surface_.triangles(place.triangle, c)];
    }
  }
  return out;
}

std::vector<Finding> SimplifiedSurface::on_whole(std::vector<Finding> findings) const {
  for (Finding& finding : findings) {
    std::vector<Index>& indices = finding.elements.indices;
    if (finding.elements.kind != ElementKind::triangles) {
      for (Index& v : indices) v = left_.vertex[v];
      continue;
    }
    PerTriangle<char> is_named(surface_.triangles.rows(), 0);
    for (const Index f : indices) is_named[f] = 1;
    indices.clear();
    for (Index f = 0; f < ssize(triangle_of_whole_); ++f) {
      if (triangle_of_whole_[f] != none && is_named[triangle_of_whole_[f]]) indices.push_back(f);
    }
  }
  return findings;
}

}  // namespace lsgp
