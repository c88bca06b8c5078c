// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/face_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lsgp {

namespace {

constexpr double hardly_fewer = 0.9;  // cells than before

}  // namespace

void FaceCells::collect(Array<Edge>& all) {
  Array<Index> begin(count() + 1, 0);
  for (Edge& edge : all) {
    if (edge.cells[0] > edge.cells[1]) std::swap(edge.cells[0], edge.cells[1]);
    ++begin[edge.cells[0] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Array<Index> cursor(begin.begin(), begin.end() - 1);
  Array<Edge> sorted(all.size());
  for (const Edge& edge : all) sorted[cursor[edge.cells[0]]++] = edge;
  for (Index cell = 0; cell < count(); ++cell) {
    std::sort(sorted.begin() + begin[cell], sorted.begin() + begin[cell + 1],
              [](const Edge& a, const Edge& b) { return a.cells[1] < b.cells[1]; });
  }
  edges.clear();
  for (const Edge& edge : sorted) {
    if (edge.cells[0] == edge.cells[1]) continue;
    if (!edges.empty() && edges.back().cells[0] == edge.cells[0] && edges.back().cells[1] == edge.cells[1])
      edges.back().cost += edge.cost;
    else
      edges.push_back(edge);
  }
}

std::pair<Array<Index>, Array<Index>> FaceCells::by_cell() const {
  Array<Index> begin(count() + 1, 0), list(2 * edges.size());
  for (const Edge& edge : edges) {
    for (const Index cell : edge.cells) ++begin[cell + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Array<Index> cursor(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const Index cell : edges[i].cells) list[cursor[cell]++] = static_cast<Index>(i);
  }
  return {std::move(begin), std::move(list)};
}

Array<Index> FaceCells::coarsen(Index held) {
  const auto [begin, list] = by_cell();
  Array<Index> order(count()), merged(count(), none);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] < area[b]; });
  for (Index cell = 0; cell < held; ++cell) merged[cell] = cell;
  Index merged_count = held;
  for (const Index cell : order) {
    if (merged[cell] != none) continue;
    Index best = none;
    double longest = 0;
    for (Index i = begin[cell]; i < begin[cell + 1]; ++i) {
      const Edge& edge = edges[list[i]];
      const Index other = edge.cells[edge.cells[0] == cell];
      if (merged[other] != none) continue;
      const double length = static_cast<double>(edge.cost) / std::sqrt(area[other]);
      if (best != none && length <= longest) continue;
      best = other;
      longest = length;
    }
    merged[cell] = merged_count++;
    if (best != none) merged[best] = merged[cell];
  }
  Array<double> areas(merged_count, 0);
  for (Index cell = 0; cell < count(); ++cell) areas[merged[cell]] += area[cell];
  area = std::move(areas);
  Array<Edge> all = std::move(edges);
  for (Edge& edge : all) {
    for (Index& cell : edge.cells) cell = merged[cell];
  }
  collect(all);
  return merged;
}

FaceGraph build_cell_graph(const FaceGraph& graph, Index most) {
  FaceCells cells;
  cells.area.assign(graph.area.begin(), graph.area.end());
  Array<FaceCells::Edge> edges;
  for (const FaceGraph::Link& link : graph.links) edges.push_back({{link.faces[0], link.faces[1]}, link.cost});
  cells.collect(edges);
  FaceGraph out = graph;
  while (cells.count() > most) {
    const Index before = cells.count();
    const Array<Index> merged = cells.coarsen(0);
    for (Index& face : out.face_of) face = merged[face];
    if (cells.count() > hardly_fewer * before) break;
  }
  out.area.assign(cells.area.begin(), cells.area.end());
  out.links.clear();
  for (const FaceCells::Edge& edge : cells.edges)
    out.links.push_back({{edge.cells[0], edge.cells[1]}, none, edge.cost});
  out.index_links();
  return out;
}

}  // namespace lsgp
