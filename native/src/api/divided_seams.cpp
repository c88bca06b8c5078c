// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/divided_seams.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace lsgp {

namespace {

PerPart<double> sizes_of_parts(const PlacedParts& parts, const CornerPositions& corners) {
  PerPart<PositionBox> boxes(parts.turn.size());
  for (Eigen::Index corner = 0; corner < corners.size(); ++corner) {
    boxes[parts.of_triangle[corner / 3]].add(corners[corner]);
  }
  PerPart<double> out;
  for (const PositionBox& box : boxes) out.push_back(box.size());
  return out;
}

}  // namespace

void check_divided_seams(const HalfedgeMesh& mesh, const PlacedParts& parts, const CornerPositions& corners,
                         ComponentMap& map) {
  const PerPart<double> size = sizes_of_parts(parts, corners);
  using Sides = std::pair<Index, Index>;
  const auto sides_of = [&](Index h) { return Sides{parts.of_triangle[h / 3], parts.of_triangle[mesh.twin[h] / 3]}; };
  const auto between = [&](const Sides& sides, std::optional<double> rotation) {
    if (rotation) *rotation += parts.turn[sides.second] - parts.turn[sides.first];
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
  std::map<Sides, SisterEdges> parted;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || map.cut_graph.is_cut[h]) continue;
    const Sides sides = sides_of(h);
    if (sides.first >= sides.second) continue;
    const auto found = parted.try_emplace(sides, between(sides, 0.0)).first;
    found->second.halfedges.push_back(h);
  }
  for (auto& [sides, edges] : parted) seams.push_back(std::move(edges));
  map.seams = measure_seams(mesh, seams, corners, map.rotation ? &map.inexact_seams : nullptr);
}

}  // namespace lsgp
