// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "split/cut_apart.hpp"
#include "split/merge_islands.hpp"
#include "split/split_overlaps.hpp"

namespace lsgp {

namespace {

// A way to divide a map: where it is open then, and how its parts move.
struct Division {
  Array<char> ends;  // (3m)
  Array<Index> part;
  Array<Motion> motion;
  double cost;
};

// Of every island, of one that is a scrap on top, and of cuts as long as the square root of the surface's area.
constexpr double cost_of_island = 0.5, cost_of_scrap = 2, cost_of_cut = 1;
constexpr double scrap = 0.005;  // of the area

double cost(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<char>& ends) {
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (ends[h] && mesh.twin[h] > h) length += geometry.length[h];
  }
  Array<Index> island;
  Array<double> area(label_parts(mesh, ends, island), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[island[f]] += geometry.area[f];
  const auto scraps =
      std::count_if(area.begin(), area.end(), [&](double own) { return own < scrap * geometry.total_area; });
  return cost_of_island * static_cast<double>(area.size()) + cost_of_scrap * static_cast<double>(scraps) +
         cost_of_cut * length / std::sqrt(geometry.total_area);
}

Division divide(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map,
                const Array<Overlap>& overlaps, const Array<char>& kept, CutCost rule, ProgressMonitor& monitor,
                Array<char> ends) {
  Division out{std::move(ends), {}, {}, 0};
  split_overlaps(
      mesh, geometry, overlaps, rule, [&] { monitor.advance(0); }, out.ends);
  out.motion.resize(label_parts(mesh, out.ends, out.part));
  if (map.rotation) out.motion = merge_islands(mesh, geometry, map, out.part, kept, out.ends);
  out.cost = cost(mesh, geometry, out.ends);
  return out;
}

}  // namespace

bool split_map(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<char>& open, const Array<char>& kept,
               ProgressMonitor& monitor, ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor, "split");
  Array<char> is_cut = map.cut_graph.is_cut, ends = open;
  Array<Index> twin = mesh.twin;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_cut[h]) continue;
    ends[h] = 1;
    twin[h] = none;
  }
  Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  for (const Index f : map.validity.flipped) {
    corners.segment<3>(3 * f).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const Array<Overlap> overlaps = find_overlaps(corners, twin);
  if (overlaps.empty()) return false;
  Division best = divide(mesh, geometry, map, overlaps, kept, CutCost::shortest, monitor, ends);
  for (const CutCost rule : {CutCost::no_slivers, CutCost::no_small_parts}) {
    Division other = divide(mesh, geometry, map, overlaps, kept, rule, monitor, ends);
    if (other.cost < best.cost) best = std::move(other);
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !best.ends[h]) {
      is_cut[h] = 0;
      continue;
    }
    // What was open before stays open, but becomes a cut where its sides move differently.
    const Motion &here = best.motion[best.part[h / 3]], &there = best.motion[best.part[mesh.twin[h] / 3]];
    is_cut[h] = is_cut[h] || !open[h] || here.angle != there.angle || here.shift != there.shift;
  }
  cut_apart(mesh, std::move(is_cut), best.part, best.motion, map);
  return true;
}

}  // namespace lsgp
