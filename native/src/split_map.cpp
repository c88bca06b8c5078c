// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_map.hpp"

#include <limits>

#include "split_overlaps.hpp"

namespace lsgp {

namespace {

// Cuts the map at all marked edges; those marked already keep their rotation.
void cut_further(const HalfedgeMesh& mesh, std::vector<char> is_cut, ComponentMap& map) {
  std::vector<char> is_node(mesh.vertex_count(), 0);
  for (const Cut& cut : map.cut_graph.cuts) is_node[cut.tail] = is_node[cut.head] = 1;
  CutGraph graph = trace_cuts(mesh, is_node, std::move(is_cut));
  if (map.rotation) {
    Eigen::VectorXd rotation = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(graph.cuts.size()));
    for (std::size_t p = 0; p < graph.cuts.size(); ++p) {
      const Index h = graph.cuts[p].halfedges.front(), before = map.cut_graph.cut_of[h];
      if (before == none) continue;
      rotation[static_cast<Eigen::Index>(p)] = (map.cut_graph.runs_forward[h] ? 1 : -1) * (*map.rotation)[before];
    }
    map.rotation = std::move(rotation);
  }
  CutMesh cut_mesh = cut_open(mesh, graph);
  Eigen::VectorXcd position(cut_mesh.copy_count());
  std::vector<Index> copy_after(map.cut_mesh.copy_count());
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index before = map.cut_mesh.copy_of_corner[corner], after = cut_mesh.copy_of_corner[corner];
    position[after] = map.position[before];
    copy_after[before] = after;
  }
  for (Pin& pin : map.pins) pin.copy = copy_after[pin.copy];
  map.position = std::move(position);
  map.cut_graph = std::move(graph);
  map.cut_mesh = std::move(cut_mesh);
}

}  // namespace

Index split_map(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open, ComponentMap& map) {
  std::vector<char> is_cut = map.cut_graph.is_cut, ends = open;
  std::vector<Index> twin = mesh.twin;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_cut[h]) continue;
    ends[h] = 1;
    twin[h] = none;
  }
  Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  for (const Index f : map.validity.flipped) {
    corners.segment<3>(3 * f).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (!has_overlap(corners, twin)) return 0;
  const Index opened = split_overlaps(mesh, geometry, find_overlaps(corners), ends);
  if (opened == 0) return 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) is_cut[h] = is_cut[h] || (ends[h] && !open[h]);
  cut_further(mesh, std::move(is_cut), map);
  return opened;
}

}  // namespace lsgp
