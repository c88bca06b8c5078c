// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/component_map.hpp"

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

}  // namespace lsgp
