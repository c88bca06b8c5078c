// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/component_map.hpp"

#include <algorithm>
#include <utility>

#include "plane/overlaps.hpp"

namespace lsgp {

void check_seams(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map) {
  map.seams = measure_seams(mesh, map.cut_graph, corners, map.rotation ? &*map.rotation : nullptr,
                            map.rotation ? &map.inexact_seams : nullptr);
}

void check_triangles(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map) {
  map.validity = check_map(mesh, corners, map.curvature.at_vertex, map.curvature.is_free);
  if (map.rotation) return;
  map.validity.wrong_angle_sums.clear();  // without transitions all angles are free
  map.validity.inexact_angles.clear();
}

void check_positions(const HalfedgeMesh& mesh, ComponentMap& map) {
  if (!map.position.allFinite()) {
    throw Error(Code::solver_failed,
                "The unfolding returned values that are not finite. Clean the mesh (merge by distance, "
                "dissolve degenerate faces) and try again.");
  }
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  map.uv_area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) map.uv_area += doubled_area(corners, f) / 2;
  check_triangles(mesh, corners, map);
}

Eigen::VectorXcd side_by_side(const PerTriangle<Index>& part, Eigen::VectorXcd position) {
  PerPart<PositionBox> boxes(1 + *std::max_element(part.begin(), part.end()));
  for (Eigen::Index c = 0; c < position.size(); ++c) boxes[part[c / 3]].add(position[c]);
  Complex at = 0;
  PerPart<Complex> shift;
  for (const PositionBox& box : boxes) {
    shift.push_back(at - box.low());
    at += 2 * box.size();
  }
  for (Eigen::Index c = 0; c < position.size() && boxes.size() > 1; ++c) position[c] += shift[part[c / 3]];
  return position;
}

bool has_overlap_within(const PerTriangle<Index>& part, Eigen::VectorXcd position, const PerHalfedge<Index>& twin) {
  return has_overlap(side_by_side(part, std::move(position)), twin);
}

}  // namespace lsgp
