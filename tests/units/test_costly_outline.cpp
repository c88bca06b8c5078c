// SPDX-License-Identifier: GPL-3.0-or-later
// Lines around what cuts should keep out of.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "lsgp/lsgp.hpp"

using namespace lsgp;

namespace {

constexpr Index columns = 12, rows = 5;

Index vertex(Index column, Index row) { return column * (rows + 1) + row; }

// Squares in columns and rows, where the cost of an edge is that of the column, and half way that of both.
Surface grid(const std::vector<double>& cost_of_column) {
  Surface out;
  out.positions.resize((columns + 1) * (rows + 1), 3);
  std::vector<Index> corners, edges;
  std::vector<double> costs;
  const auto add = [&](Index a, Index b, double cost) {
    edges.insert(edges.end(), {a, b});
    costs.push_back(cost);
  };
  for (Index i = 0; i <= columns; ++i) {
    for (Index j = 0; j <= rows; ++j) {
      out.positions.row(vertex(i, j)) << i, j, 0;
      if (j < rows) add(vertex(i, j), vertex(i, j + 1), cost_of_column[i]);
      if (i < columns) add(vertex(i, j), vertex(i + 1, j), (cost_of_column[i] + cost_of_column[i + 1]) / 2);
      if (i == columns || j == rows) continue;
      const Index a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      corners.insert(corners.end(), {a, b, c, a, c, d});
    }
  }
  out.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Index>(corners.size()) / 3, 3);
  out.edges = VertexPairs(Eigen::Map<const VertexPairs>(edges.data(), static_cast<Index>(edges.size()) / 2, 2));
  out.cut_costs = Eigen::Map<const Eigen::VectorXd>(costs.data(), static_cast<Index>(costs.size()));
  return out;
}

// Dear on the left, and no more than usual from one column on.
std::vector<double> costs_with(double between, Index first_cheap) {
  std::vector<double> out(columns + 1, 0.5);
  for (Index i = 0; i < first_cheap; ++i) out[i] = i < 4 ? 30 : between;
  return out;
}

}  // namespace

TEST_CASE("the outline runs along the cheapest line between dear and cheap") {
  for (const Index cheapest : {6, 8, 9}) {
    const VertexPairs outline = costly_outline(grid(costs_with(5, cheapest)));
    std::set<std::pair<Index, Index>> found, expected;
    for (Index e = 0; e < outline.rows(); ++e) found.insert(std::minmax(outline(e, 0), outline(e, 1)));
    for (Index j = 0; j < rows; ++j) expected.insert({vertex(cheapest, j), vertex(cheapest, j + 1)});
    CHECK(found == expected);
  }
}

TEST_CASE("where cuts cost the same, or nowhere much, nothing is enclosed") {
  CHECK(costly_outline(grid(std::vector<double>(columns + 1, 30))).rows() == 0);
  CHECK(costly_outline(grid(std::vector<double>(columns + 1, 0.1))).rows() == 0);
  Surface without = grid(costs_with(5, 6));
  without.cut_costs.resize(0);
  CHECK(costly_outline(without).rows() == 0);
}

TEST_CASE("no outline parts the triangles of a polygon") {
  Surface surface = grid(costs_with(5, 6));
  // The column of edges that would be cheapest is none that cuts may follow.
  std::vector<Index> edges;
  std::vector<double> costs;
  for (Index e = 0; e < surface.edges->rows(); ++e) {
    const Index a = (*surface.edges)(e, 0), b = (*surface.edges)(e, 1);
    if (a / (rows + 1) == 6 && b / (rows + 1) == 6) continue;
    edges.insert(edges.end(), {a, b});
    costs.push_back(surface.cut_costs[e]);
  }
  surface.edges = VertexPairs(Eigen::Map<const VertexPairs>(edges.data(), static_cast<Index>(edges.size()) / 2, 2));
  surface.cut_costs = Eigen::Map<const Eigen::VectorXd>(costs.data(), static_cast<Index>(costs.size()));
  const VertexPairs outline = costly_outline(surface);
  CHECK(outline.rows() == rows);
  for (Index e = 0; e < outline.rows(); ++e) CHECK(outline(e, 0) / (rows + 1) != 6);
}
