// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/face_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

constexpr double seam_factor = 0.2, sharp_factor = 0.5;
// Of what the surface's median edge costs as a cut: none is cheaper than a seam, none keeps cuts away at any length.
constexpr double least_factor = seam_factor, largest_factor = 10;
constexpr double units_of_mean_edge = 1e4;

double sharpness_factor(const HalfedgeMesh& mesh, Index h) {
  return bend_at(mesh, h) > smooth_bend ? sharp_factor : 1.0;
}

}  // namespace

PerHalfedge<double> relative_cut_factors(const HalfedgeMesh& mesh) {
  PerHalfedge<double> factor = mesh.cut_factor;
  Array<double> of_edges;
  for (Index h = 0; h < ssize(factor); ++h) {
    if (mesh.twin[h] > h && mesh.cuttable[h]) of_edges.push_back(factor[h]);
  }
  if (of_edges.empty()) return {};
  const auto median = of_edges.begin() + static_cast<std::ptrdiff_t>(of_edges.size() / 2);
  std::nth_element(of_edges.begin(), median, of_edges.end());
  // Most edges may cost nothing.
  const double unit = std::max(*median, std::numeric_limits<double>::min());
  for (double& own : factor) own = std::clamp(own / unit, least_factor, largest_factor);
  return factor;
}

HalfedgeMesh weighing_length(const HalfedgeMesh& mesh) {
  HalfedgeMesh out = mesh;
  out.cut_factor = relative_cut_factors(mesh);
  for (double& factor : out.cut_factor) factor = (1 + factor) / 2;
  return out;
}

FaceGraph build_face_graph(const OpenedSurface& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const PerHalfedge<char>& open = surface.open;
  FaceGraph graph;
  PerHalfedge<char> is_side(mesh.halfedge_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) is_side[h] = open[h] || mesh.cuttable[h];
  graph.area.assign(label_parts(mesh, is_side, graph.face_of), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) graph.area[graph.face_of[f]] += geometry.area[f];
  graph.total_area = geometry.total_area;
  graph.unit = geometry.length.mean() / units_of_mean_edge;
  const PerHalfedge<double> factor = relative_cut_factors(mesh);
  graph.link_begin.assign(graph.face_count() + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin < h || open[h] || graph.face_of[h / 3] == graph.face_of[twin / 3]) continue;
    const double weight = mesh.seam[h] ? seam_factor : factor.empty() ? sharpness_factor(mesh, h) : factor[h];
    const double units = geometry.length[h] * weight / graph.unit;
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
