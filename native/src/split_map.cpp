// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_map.hpp"

#include <limits>

#include "join_parts.hpp"
#include "split_overlaps.hpp"

namespace lsgp {

namespace {

// Cuts the map at all marked edges and moves its parts, (m) of every triangle.
void cut_apart(const HalfedgeMesh& mesh, std::vector<char> is_cut, const std::vector<Index>& part,
               const std::vector<Motion>& motion, ComponentMap& map) {
  std::vector<char> is_node(mesh.vertex_count(), 0);
  for (const Index v : map.cones) is_node[v] = 1;
  CutGraph graph = trace_cuts(mesh, is_node, std::move(is_cut));
  if (map.rotation) {
    Eigen::VectorXd rotation = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(graph.cuts.size()));
    for (std::size_t p = 0; p < graph.cuts.size(); ++p) {
      const Index h = graph.cuts[p].halfedges.front(), before = map.cut_graph.cut_of[h];
      double& r = rotation[static_cast<Eigen::Index>(p)];
      if (before != none) r = (map.cut_graph.runs_forward[h] ? 1 : -1) * (*map.rotation)[before];
      r += motion[part[mesh.twin[h] / 3]].angle - motion[part[h / 3]].angle;
    }
    map.rotation = std::move(rotation);
  }
  CutMesh cut_mesh = cut_open(mesh, graph);
  Eigen::VectorXcd position(cut_mesh.copy_count());
  std::vector<Index> copy_after(map.cut_mesh.copy_count());
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index before = map.cut_mesh.copy_of_corner[corner], after = cut_mesh.copy_of_corner[corner];
    position[after] = motion[part[corner / 3]](map.position[before]);
    copy_after[before] = after;
  }
  for (Pin& pin : map.pins) pin.copy = copy_after[pin.copy];
  map.position = std::move(position);
  map.cut_graph = std::move(graph);
  map.cut_mesh = std::move(cut_mesh);
}

}  // namespace

bool split_map(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open,
               const std::vector<char>& kept, ComponentMap& map) {
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
  if (!has_overlap(corners, twin)) return false;
  if (split_overlaps(mesh, geometry, find_overlaps(corners), ends) == 0) return false;
  std::vector<Index> part;
  const Index part_count = label_parts(mesh, ends, part);
  std::vector<Motion> motion(part_count);
  if (map.rotation) motion = join_parts(mesh, geometry, map, part, kept, ends);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !ends[h]) continue;
    const Motion &here = motion[part[h / 3]], &there = motion[part[mesh.twin[h] / 3]];
    is_cut[h] = is_cut[h] || !open[h] || here.angle != there.angle || here.shift != there.shift;
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) is_cut[h] = is_cut[h] && ends[h];
  cut_apart(mesh, std::move(is_cut), part, motion, map);
  return true;
}

}  // namespace lsgp
