// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/divided_seams.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace lsgp {

namespace {

PerPart<double> island_sizes(const PlacedIslands& islands, const CornerPositions& corners) {
  PerPart<PositionBox> boxes(islands.turn.size());
  for (Eigen::Index corner = 0; corner < corners.size(); ++corner) {
    boxes[islands.of_triangle[corner / 3]].add(corners[corner]);
  }
  PerPart<double> out;
  for (const PositionBox& box : boxes) out.push_back(box.size());
  return out;
}

}  // namespace

void check_divided_seams(const HalfedgeMesh& mesh, const PlacedIslands& islands, const CornerPositions& corners,
                         ComponentMap& map) {
  const PerPart<double> size = island_sizes(islands, corners);
  using Sides = std::pair<Index, Index>;
  const auto sides_of = [&](Index h) {
    return Sides{islands.of_triangle[h / 3], islands.of_triangle[mesh.twin[h] / 3]};
  };
  const auto between = [&](const Sides& sides, std::optional<double> rotation) {
    if (rotation) *rotation += islands.turn[sides.second] - islands.turn[sides.first];
    return SisterEdges{{}, rotation, std::max(size[sides.first], size[sides.second])};
  };
  Array<SisterEdges> seams;
  for (std::size_t p = 0; p < map.cut_graph.cuts.size(); ++p) {
    std::optional<double> rotation;
    if (map.rotation) rotation = (*map.rotation)[static_cast<Eigen::Index>(p)];
    std::optional<Sides> before;
    for (const Index h : map.cut_graph.cuts[p].halfedges) {
      const Sides sides = sides_of(h);
      if (before != sides) seams.push_back(between(sides, rotation));
      seams.back().halfedges.push_back(h);
      before = sides;
    }
  }
  std::map<Sides, SisterEdges> divided;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || map.cut_graph.is_cut[h]) continue;
    const Sides sides = sides_of(h);
    if (sides.first >= sides.second) continue;
    const auto found = divided.try_emplace(sides, between(sides, 0.0)).first;
    found->second.halfedges.push_back(h);
  }
  for (auto& [sides, edges] : divided) seams.push_back(std::move(edges));
  map.seams = measure_seams(mesh, seams, corners, map.rotation ? &map.inexact_seams : nullptr);
}

}  // namespace lsgp
