// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/face_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lsgp {

namespace {

constexpr double seam_discount = 0.2, sharp_discount = 0.5;
const double sharp_angle = M_PI / 6;
constexpr double units_of_mean_edge = 1e4;

double discount(const HalfedgeMesh& mesh, Index h) {
  if (mesh.seam[h]) return seam_discount;
  const auto normal = [&](Index f) { return area_normal(mesh.positions, mesh.triangles, f); };
  return angle_between(normal(h / 3), normal(mesh.twin[h] / 3)) > sharp_angle ? sharp_discount : 1.0;
}

}  // namespace

FaceGraph build_face_graph(const OpenedSurface& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Array<char>& open = surface.open;
  FaceGraph graph;
  Array<char> is_side(mesh.halfedge_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) is_side[h] = open[h] || mesh.cuttable[h];
  graph.area.assign(label_parts(mesh, is_side, graph.face_of), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) graph.area[graph.face_of[f]] += geometry.area[f];
  graph.total_area = geometry.total_area;
  graph.unit = geometry.length.mean() / units_of_mean_edge;
  graph.link_begin.assign(graph.face_count() + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin < h || open[h] || graph.face_of[h / 3] == graph.face_of[twin / 3]) continue;
    const double units = geometry.length[h] * discount(mesh, h) / graph.unit;
    graph.links.push_back(
        {{graph.face_of[h / 3], graph.face_of[twin / 3]}, h, std::max<FaceGraph::Units>(1, std::llround(units))});
    for (const Index face : graph.links.back().faces) ++graph.link_begin[face + 1];
  }
  std::partial_sum(graph.link_begin.begin(), graph.link_begin.end(), graph.link_begin.begin());
  graph.link_of_face.resize(2 * graph.links.size());
  Array<Index> cursor(graph.link_begin.begin(), graph.link_begin.end() - 1);
  for (std::size_t i = 0; i < graph.links.size(); ++i) {
    for (const Index face : graph.links[i].faces) graph.link_of_face[cursor[face]++] = static_cast<Index>(i);
  }
  return graph;
}

}  // namespace lsgp
