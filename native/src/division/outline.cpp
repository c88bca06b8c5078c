// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/array.hpp"
#include "base/lower_quartile.hpp"
#include "base/union_find.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"
#include "solvers/smallest_cut.hpp"

namespace lsgp {

namespace {

// What a cut costs where it is dear, of the usual cost: of the views around the front seven tenths see the edge.
constexpr double dear = 10;
// The power of an edge's cost by which its length counts. On twelve generated figures lines by costs alone go so far
// behind that pieces are stretched by more than 1.05, or lie on themselves; by length alone half of the views see them.
constexpr double weight_of_cost = 0.25;
constexpr double least_piece = 0.01;  // of a component's area
constexpr double units_of_mean_price = 1e4;

// An edge that cuts may follow, between two triangles.
struct Link {
  Index edge, triangles[2];
};

class Outline {
 public:
  explicit Outline(const Surface& surface)
      : surface_(surface),
        edges_(surface, PerTriangle<char>(surface.triangles.rows(), 0)),
        cost_(edges_.count(), uncut),
        solid_(static_cast<Index>(surface.triangles.rows())) {
    const double usual = std::max(1.0, lower_quartile(surface.cut_costs));
    for (Eigen::Index row = 0; row < surface.cut_costs.size(); ++row) {
      const Index edge = edges_.find((*surface.edges)(row, 0), (*surface.edges)(row, 1));
      if (edge != none) cost_[edge] = surface.cut_costs[row] / usual;
    }
    find_links();
  }

  VertexPairs find() {
    if (!divide()) return VertexPairs(0, 2);
    join_small_pieces();
    Array<std::pair<Index, Index>> found;
    for (const Link& link : links_) {
      if (is_dear_[link.triangles[0]] == is_dear_[link.triangles[1]]) continue;
      const Index h = edges_.halfedge(link.edge, 0);
      found.emplace_back(corner(h), corner(next(h)));
    }
    VertexPairs out(ssize(found), 2);
    for (std::ptrdiff_t e = 0; e < ssize(found); ++e) out.row(e) << found[e].first, found[e].second;
    return out;
  }

 private:
  static constexpr double uncut = -1;

  Index corner(Index halfedge) const { return surface_.triangles.data()[halfedge]; }
  double length(Index edge) const {
    const Index h = edges_.halfedge(edge, 0);
    return (surface_.positions.row(corner(h)) - surface_.positions.row(corner(next(h)))).norm();
  }

  void find_links() {
    for (Index edge = 0; edge < edges_.count(); ++edge) {
      const Index first = edges_.halfedge(edge, 0) / 3;
      if (edges_.halfedge_count(edge) == 2 && cost_[edge] != uncut) {
        links_.push_back({edge, {first, edges_.halfedge(edge, 1) / 3}});
        continue;
      }
      for (Index i = 1; i < edges_.halfedge_count(edge); ++i) solid_.unite(first, edges_.halfedge(edge, i) / 3);
    }
  }

  // Which triangles are enclosed; false where none are.
  bool divide() {
    const auto count = static_cast<Index>(surface_.triangles.rows());
    PerTriangle<double> most(count, 0);  // of solid faces
    for (const Link& link : links_) {
      for (const Index f : link.triangles) most[solid_.find(f)] = std::max(most[solid_.find(f)], cost_[link.edge]);
    }
    PerTriangle<int> node(count, 0);
    int nodes = 2;  // those of dear and of cheap triangles are the first two
    bool has_dear = false, has_cheap = false;
    for (Index f = 0; f < count; ++f) {
      if (solid_.find(f) != f) continue;
      has_dear |= most[f] >= dear;
      has_cheap |= most[f] <= 1;
      node[f] = most[f] >= dear ? 0 : most[f] <= 1 ? 1 : nodes++;
    }
    if (!has_dear || !has_cheap) return false;
    double mean = 0;
    for (const Link& link : links_) mean += length(link.edge) / static_cast<double>(links_.size());
    if (!(mean > 0)) return false;
    Array<SmallestCut::Edge> between;
    for (const Link& link : links_) {
      int ends[2] = {node[solid_.find(link.triangles[0])], node[solid_.find(link.triangles[1])]};
      if (ends[0] == ends[1]) continue;
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      const double price = length(link.edge) * std::pow(std::max(1.0, cost_[link.edge]), weight_of_cost);
      between.push_back({{ends[0], ends[1]}, 1 + std::llround(units_of_mean_price * price / mean)});
    }
    SmallestCut network(nodes, merged(std::move(between)));
    network.add_to_first(0);
    network.add_to_second(1);
    network.find_smallest();
    const Array<char> is_first = network.first_side();
    is_dear_.resize(count);
    for (Index f = 0; f < count; ++f) is_dear_[f] = is_first[node[solid_.find(f)]];
    return true;
  }

  // One edge between any two nodes.
  static Array<SmallestCut::Edge> merged(Array<SmallestCut::Edge> edges) {
    const auto ends = [](const SmallestCut::Edge& edge) { return std::pair(edge.nodes[0], edge.nodes[1]); };
    std::stable_sort(edges.begin(), edges.end(), [&](const auto& a, const auto& b) { return ends(a) < ends(b); });
    Array<SmallestCut::Edge> out;
    for (const SmallestCut::Edge& edge : edges) {
      if (!out.empty() && ends(out.back()) == ends(edge))
        out.back().capacity += edge.capacity;
      else
        out.push_back(edge);
    }
    return out;
  }

  // Pieces too small for an island of their own change sides, and so go with what is around them unless that is such a
  // piece, too.
  void join_small_pieces() {
    const auto count = static_cast<Index>(surface_.triangles.rows());
    UnionFind pieces = solid_, components = solid_;
    for (const Link& link : links_) {
      components.unite(link.triangles[0], link.triangles[1]);
      if (is_dear_[link.triangles[0]] == is_dear_[link.triangles[1]])
        pieces.unite(link.triangles[0], link.triangles[1]);
    }
    PerTriangle<double> of_piece(count, 0), of_component(count, 0);
    for (Index f = 0; f < count; ++f) {
      const double area = area_normal(surface_.positions, surface_.triangles, f).norm() / 2;
      of_piece[pieces.find(f)] += area;
      of_component[components.find(f)] += area;
    }
    for (Index f = 0; f < count; ++f) {
      if (of_piece[pieces.find(f)] < least_piece * of_component[components.find(f)]) is_dear_[f] = !is_dear_[f];
    }
  }

  const Surface& surface_;
  const EdgeTable edges_;
  Array<double> cost_;  // of edges, of the usual cost
  UnionFind solid_;     // triangles that no cut may part
  Array<Link> links_;
  PerTriangle<char> is_dear_;
};

}  // namespace

VertexPairs find_outline(const Surface& surface) {
  if (surface.cut_costs.size() == 0 || !surface.edges) return VertexPairs(0, 2);
  return Outline(surface).find();
}

}  // namespace lsgp
