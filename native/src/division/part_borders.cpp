// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/part_borders.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace lsgp {

Array<PartBorder> find_part_borders(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept,
                                    const MapParts& parts) {
  const HalfedgeMesh& mesh = surface.mesh;
  const PerTriangle<Index>& part = parts.part;
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  std::map<std::tuple<Index, Index, Index>, PartBorder> borders;  // by cut, left and right part
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h], cut = map.cut_graph.cut_of[h];
    if (twin == none || !parts.open[h] || kept[h] || part[h / 3] == part[twin / 3]) continue;
    if (cut == none ? h > twin : !map.cut_graph.runs_forward[h]) continue;
    PartBorder& border = borders[{cut, part[h / 3], part[twin / 3]}];
    if (border.halfedges.empty()) {
      border.left = part[h / 3];
      border.right = part[twin / 3];
      if (cut != none) {
        const double angle = (*map.rotation)[cut];
        border.across = {angle, corners[next(twin)] - std::polar(1.0, angle) * corners[h]};
      }
    }
    border.halfedges.push_back(h);
    border.length += surface.geometry.length[h];
  }
  Array<PartBorder> out;
  for (auto& [key, border] : borders) out.push_back(std::move(border));
  std::stable_sort(out.begin(), out.end(),
                   [](const PartBorder& a, const PartBorder& b) { return a.length > b.length; });
  return out;
}

double size_of(const Eigen::VectorXcd& corners) {
  return std::max(corners.real().maxCoeff() - corners.real().minCoeff(),
                  corners.imag().maxCoeff() - corners.imag().minCoeff());
}

bool is_rest(const Motion& motion, double size) {
  constexpr double same_place = 1e-9;  // of the layout's size
  return std::abs(std::polar(1.0, motion.angle) - 1.0) <= same_place && std::abs(motion.shift) <= same_place * size;
}

}  // namespace lsgp
