// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/simplified_surface.hpp"

#include <algorithm>
#include <utility>

#include "mesh/edge_table.hpp"
#include "mesh/vertex_costs.hpp"
#include "unwrap/made_map.hpp"

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
    : thinned_(thinned(whole, kept, triangles)), node_(whole.positions.rows(), none) {
  for (const Index v : thinned_.triangles.reshaped()) node_[v] = 0;
  for (Index v = 0; v < ssize(node_); ++v) {
    if (node_[v] == none) continue;
    node_[v] = static_cast<Index>(vertex_of_node_.size());
    vertex_of_node_.push_back(v);
  }
  triangle_of_whole_.resize(whole.triangles.rows());
  for (Index f = 0; f < whole.triangles.rows(); ++f) {
    const Index* const corners = whole.triangles.row(f).data();
    const auto is_gone = [&](Index v) { return thinned_.place[v].corner() == none; };
    const Index* const gone = std::find_if(corners, corners + 3, is_gone);
    triangle_of_whole_[f] = gone == corners + 3 ? thinned_.kept[f] : thinned_.place[*gone].triangle;
  }
  const auto left = [&](const auto& values) {
    Eigen::VectorXd out(values.size() == 0 ? 0 : ssize(vertex_of_node_));
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = values[vertex_of_node_[i]];
    return out;
  };
  surface_.positions.resize(ssize(vertex_of_node_), 3);
  for (Index i = 0; i < ssize(vertex_of_node_); ++i)
    surface_.positions.row(i) = whole.positions.row(vertex_of_node_[i]);
  surface_.triangles = thinned_.triangles;
  for (Index& v : surface_.triangles.reshaped()) v = node_[v];
  surface_.seams = from_whole(whole.seams);
  surface_.borders = from_whole(whole.borders);
  surface_.features = from_whole(whole.features);
  surface_.may_collapse = whole.may_collapse;
  surface_.importance = left(whole.importance);
  const Eigen::VectorXd cost = left(costs_at_vertices(whole));
  if (cost.size() > 0) take_costs(cost, surface_);
}

VertexPairs SimplifiedSurface::from_whole(VertexPairs pairs) const {
  for (Index& v : pairs.reshaped()) v = node_[v];
  return pairs;
}

VertexPairs SimplifiedSurface::on_whole(VertexPairs pairs) const {
  for (Index& v : pairs.reshaped()) v = vertex_of_node_[v];
  return pairs;
}

CompletedCones SimplifiedSurface::on_whole(CompletedCones cones) const {
  for (Index& v : cones.cones.vertices) v = vertex_of_node_[v];
  if (!cones.placement) return cones;
  Placement& placement = *cones.placement;
  for (Index& v : placement.cones) v = vertex_of_node_[v];
  placement.log_scale = on_whole(placement.log_scale);
  placement.warnings = on_whole(std::move(placement.warnings));
  return cones;
}

Eigen::VectorXd SimplifiedSurface::on_whole(const Eigen::VectorXd& at_vertices) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(ssize(node_));
  if (at_vertices.size() == 0) return out;
  for (Index v = 0; v < ssize(node_); ++v) {
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
      for (Index& v : indices) v = vertex_of_node_[v];
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
