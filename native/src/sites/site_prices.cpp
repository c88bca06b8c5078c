// SPDX-License-Identifier: GPL-3.0-or-later
#include "sites/site_prices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/lower_quartile.hpp"
#include "base/union_find.hpp"
#include "cut/cut_cost.hpp"
#include "cut/shortest_paths.hpp"

namespace lsgp {

namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

double factor_of(const HalfedgeMesh& mesh, Index h) { return mesh.seam[h] ? 0 : mesh.cut_factor[h]; }

// Edges that cuts may follow, one halfedge each.
Array<Index> cut_edges(const HalfedgeMesh& mesh) {
  Array<Index> out;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (may_cut(mesh, h) && h < mesh.twin[h]) out.push_back(h);
  }
  return out;
}

// The vertices of the largest network of edges of at most this factor.
PathStarts largest_network(const HalfedgeMesh& mesh, const Array<Index>& edges, double cheap) {
  UnionFind networks(mesh.vertex_count());
  for (const Index h : edges) {
    if (factor_of(mesh, h) <= cheap) networks.unite(mesh.origin(h), mesh.target(h));
  }
  PerVertex<Index> size(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) ++size[networks.find(v)];
  const Index largest = static_cast<Index>(std::max_element(size.begin(), size.end()) - size.begin());
  PathStarts out;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (networks.find(v) == largest) out.emplace_back(0, v);
  }
  return out;
}

// 0 to 1, (n).
Eigen::VectorXd vertex_prices(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.vertex_count());
  const Array<Index> edges = cut_edges(mesh);
  if (edges.empty()) return out;
  Array<double> factors;
  for (const Index h : edges) factors.push_back(factor_of(mesh, h));
  const double cheap = lower_quartile(factors), dearest = *std::max_element(factors.begin(), factors.end());
  if (!(cheap < dearest)) return out;
  const PathStarts starts = largest_network(mesh, edges, cheap);
  PerVertex<Reached> reached(mesh.vertex_count());
  for (const auto& [distance, v] : starts) reached[v] = {distance, none, v};
  grow_paths(CutEdges(surface), {starts}, [](Index) { return true; }, reached);
  double farthest = 0;
  for (const Reached& at : reached) {
    if (at.distance < unreached) farthest = std::max(farthest, at.distance);
  }
  if (farthest == 0) return out;
  // Costs that hardly differ have hardly any weight.
  const double contrast = 1 - cheap / dearest;
  for (Index v = 0; v < out.size(); ++v) out[v] = contrast * std::min(reached[v].distance / farthest, 1.0);
  return out;
}

}  // namespace

Eigen::VectorXd site_prices(const MetricMesh& surface, const Array<Site>& sites) {
  const HalfedgeMesh& mesh = surface.mesh;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sites.size()));
  if (mesh.cut_factor.empty()) return out;
  const Eigen::VectorXd at = vertex_prices(surface);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const Site& site = sites[static_cast<std::size_t>(i)];
    out[i] = at[site.vertex] + (site.mirrored == none ? 0 : at[site.mirrored]);
  }
  return out;
}

}  // namespace lsgp
