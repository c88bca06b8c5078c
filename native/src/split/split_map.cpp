// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_map.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "split/cut_apart.hpp"
#include "split/merge_islands.hpp"
#include "split/recut.hpp"
#include "split/split_overlaps.hpp"

namespace lsgp {

namespace {

// Cost of every island, additional cost of a sliver, and cost of cuts as long as the square root of the surface's area.
constexpr double cost_of_island = 0.5, cost_of_sliver = 2, cost_of_cut = 1;
constexpr double sliver = 0.005;  // of the area

// factor: as from relative_cut_factors.
double cost(const MetricMesh& surface, const PerHalfedge<double>& factor, const PerHalfedge<char>& ends) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (ends[h] && mesh.twin[h] > h) length += geometry.length[h] * (factor.empty() ? 1 : factor[h]);
  }
  PerTriangle<Index> island;
  PerPart<double> area(label_parts(mesh, ends, island), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[island[f]] += geometry.area[f];
  const auto slivers =
      std::count_if(area.begin(), area.end(), [&](double own) { return own < sliver * geometry.total_area; });
  return cost_of_island * static_cast<double>(area.size()) + cost_of_sliver * static_cast<double>(slivers) +
         cost_of_cut * length / std::sqrt(geometry.total_area);
}

// A division of a map.
struct Division {
  MapParts parts;
  double cost;
};

Array<Overlap> find_own_overlaps(const HalfedgeMesh& mesh, const ComponentMap& map) {
  PerHalfedge<Index> twin = mesh.twin;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (map.cut_graph.is_cut[h]) twin[h] = none;
  }
  Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  for (const Index f : map.validity.flipped) {
    corners.segment<3>(3 * f).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return find_overlaps(corners, twin);
}

// The candidate divisions of a map that overlaps itself.
class MapDivider {
 public:
  // surface: where the map is open, cuts included.  kept: as for split_map.
  MapDivider(const OpenedSurface& surface, const ComponentMap& map, const PerHalfedge<char>& kept,
             ProgressMonitor& monitor)
      : surface_(surface),
        map_(map),
        kept_(kept),
        monitor_(monitor),
        overlaps_(find_own_overlaps(surface.mesh, map)),
        factor_(relative_cut_factors(surface.mesh)) {}

  bool is_whole() const { return overlaps_.empty(); }
  double cost_before() const { return cost(surface_, factor_, surface_.open); }

  Division divide(CutCost rule) const {
    const HalfedgeMesh& mesh = surface_.mesh;
    MapParts parts{surface_.open, {}, {}};
    const Array<Index> opened = split_overlaps(surface_, overlaps_, rule, [&] { monitor_.advance(0); });
    for (const Index h : opened) parts.open[h] = parts.open[mesh.twin[h]] = 1;
    parts.motion.resize(label_parts(mesh, parts.open, parts.part));
    if (map_.rotation) merge_islands(surface_, map_, kept_, parts);
    const double total = cost(surface_, factor_, parts.open);
    return {std::move(parts), total};
  }

 private:
  const OpenedSurface surface_;
  const ComponentMap& map_;
  const PerHalfedge<char>& kept_;
  ProgressMonitor& monitor_;
  const Array<Overlap> overlaps_;
  const PerHalfedge<double> factor_;  // of edges as cuts
};

// Where a map is open: where it was before, and along its cuts.
PerHalfedge<char> ends_of(const OpenedSurface& surface, const ComponentMap& map) {
  PerHalfedge<char> ends = surface.open;
  for (std::size_t h = 0; h < ends.size(); ++h) ends[h] = ends[h] || map.cut_graph.is_cut[h];
  return ends;
}

// The cheapest division of maps that differ by their cuts.
class WaySearch {
 public:
  WaySearch(const OpenedSurface& surface, const PerHalfedge<char>& kept, ProgressMonitor& monitor)
      : surface_(surface), kept_(kept), monitor_(monitor) {}

  // least: dividing an overlapping layout is assumed to add at least this cost.
  void divide(const ComponentMap& way, std::initializer_list<CutCost> rules, double least) {
    const PerHalfedge<char> ends = ends_of(surface_, way);
    const MapDivider divider({surface_, ends}, way, kept_, monitor_);
    for (const CutCost rule : rules) {
      if (chosen_ && divider.cost_before() + (divider.is_whole() ? 0 : least) >= best_.cost) break;
      Division other = divider.divide(rule);
      if (chosen_ && !(other.cost < best_.cost)) continue;
      best_ = std::move(other);
      chosen_ = &way;
    }
  }

  const Division& best() const { return best_; }
  const ComponentMap* chosen() const { return chosen_; }

 private:
  const OpenedSurface& surface_;
  const PerHalfedge<char>& kept_;
  ProgressMonitor& monitor_;
  Division best_{};
  const ComponentMap* chosen_ = nullptr;  // none so far
};

// Marked seams, straight cuts and pinned islands stay as they are.
bool may_recut(const PerHalfedge<char>& kept, const ComponentMap& map) {
  return map.rotation && !map.has_straight_cuts && map.pins.empty() && !map.cut_graph.cuts.empty() &&
         std::find(kept.begin(), kept.end(), 1) == kept.end();
}

// The map of the pieces that a division leaves.
void apply(const OpenedSurface& surface, const MapParts& parts, ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const auto& [parts_open, part, motion] = parts;
  PerHalfedge<char> is_cut = map.cut_graph.is_cut;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || !parts_open[h]) {
      is_cut[h] = 0;
      continue;
    }
    // Open edges stay open, but become cuts if their sides move differently.
    const Motion &here = motion[part[h / 3]], &there = motion[part[mesh.twin[h] / 3]];
    is_cut[h] = is_cut[h] || !surface.open[h] || here.angle != there.angle || here.shift != there.shift;
  }
  cut_apart(mesh, std::move(is_cut), part, motion, map);
}

}  // namespace

bool split_map(const OpenedSurface& surface, const PerHalfedge<char>& kept, ProgressMonitor& monitor,
               ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor, "split");
  if (find_own_overlaps(surface.mesh, map).empty()) return false;
  // The fastest rule selects among the recut maps. The map's own cuts compete with every rule, so that recutting never
  // costs more.
  const Array<ComponentMap> ways = may_recut(kept, map) ? recut(surface, map) : Array<ComponentMap>{};
  WaySearch search(surface, kept, monitor);
  for (const ComponentMap& way : ways) search.divide(way, {CutCost::shortest}, cost_of_island);
  if (search.chosen()) search.divide(*search.chosen(), {CutCost::no_slivers, CutCost::no_small_parts}, 0);
  search.divide(map, {CutCost::shortest, CutCost::no_slivers, CutCost::no_small_parts}, 0);
  ComponentMap chosen = *search.chosen();
  apply(surface, search.best().parts, chosen);
  map = std::move(chosen);
  return true;
}

}  // namespace lsgp
