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

// Cost of every island, additional cost of a sliver, and cost of cuts as long as the square root of the surface's area.
constexpr double cost_of_island = 0.5, cost_of_scrap = 2, cost_of_cut = 1;
constexpr double scrap = 0.005;  // of the area

// factor: as from relative_cut_factors.
double cost(const HalfedgeMesh& mesh, const Geometry& geometry, const Array<double>& factor, const Array<char>& ends) {
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (ends[h] && mesh.twin[h] > h) length += geometry.length[h] * (factor.empty() ? 1 : factor[h]);
  }
  Array<Index> island;
  Array<double> area(label_parts(mesh, ends, island), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[island[f]] += geometry.area[f];
  const auto scraps =
      std::count_if(area.begin(), area.end(), [&](double own) { return own < scrap * geometry.total_area; });
  return cost_of_island * static_cast<double>(area.size()) + cost_of_scrap * static_cast<double>(scraps) +
         cost_of_cut * length / std::sqrt(geometry.total_area);
}

// A division of a map.
struct Division {
  MapParts parts;
  double cost;
};

// The candidate divisions of a map that overlaps itself.
class MapDivider {
 public:
  // surface: where the map is open, cuts included.  kept: (3m).
  MapDivider(const OpenedSurface& surface, const ComponentMap& map, const Array<Overlap>& overlaps,
             const Array<char>& kept, ProgressMonitor& monitor)
      : surface_(surface),
        map_(map),
        overlaps_(overlaps),
        kept_(kept),
        monitor_(monitor),
        factor_(relative_cut_factors(surface.mesh)) {}

  Division divide(CutCost rule) const {
    const auto& [mesh, geometry, open] = surface_;
    MapParts parts{open, {}, {}};
    const Array<Index> opened = split_overlaps(surface_, overlaps_, rule, [&] { monitor_.advance(0); });
    for (const Index h : opened) parts.open[h] = parts.open[mesh.twin[h]] = 1;
    parts.motion.resize(label_parts(mesh, parts.open, parts.part));
    if (map_.rotation) merge_islands(mesh, geometry, map_, kept_, parts);
    const double total = cost(mesh, geometry, factor_, parts.open);
    return {std::move(parts), total};
  }

 private:
  const OpenedSurface& surface_;
  const ComponentMap& map_;
  const Array<Overlap>& overlaps_;
  const Array<char>& kept_;
  ProgressMonitor& monitor_;
  const Array<double> factor_;  // (3m) of edges as cuts
};

}  // namespace

bool split_map(const OpenedSurface& surface, const Array<char>& kept, ProgressMonitor& monitor, ComponentMap& map) {
  const auto& [mesh, geometry, open] = surface;
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
  const OpenedSurface opened{mesh, geometry, ends};
  const MapDivider divider(opened, map, overlaps, kept, monitor);
  Division best = divider.divide(CutCost::shortest);
  for (const CutCost rule : {CutCost::no_slivers, CutCost::no_small_parts}) {
    Division other = divider.divide(rule);
    if (other.cost < best.cost) best = std::move(other);
  }
  const auto& [parts_open, part, motion] = best.parts;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !parts_open[h]) {
      is_cut[h] = 0;
      continue;
    }
    // Open edges stay open, but become cuts if their sides move differently.
    const Motion &here = motion[part[h / 3]], &there = motion[part[mesh.twin[h] / 3]];
    is_cut[h] = is_cut[h] || !open[h] || here.angle != there.angle || here.shift != there.shift;
  }
  cut_apart(mesh, std::move(is_cut), part, motion, map);
  return true;
}

}  // namespace lsgp
