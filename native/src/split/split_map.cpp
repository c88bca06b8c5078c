// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_map.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "division/cut_apart.hpp"
#include "pieces/division_price.hpp"
#include "pieces/recut.hpp"
#include "pieces/regroup.hpp"
#include "plane/convex_hull.hpp"
#include "split/merge_islands.hpp"
#include "split/mirrored_islands.hpp"
#include "split/own_overlaps.hpp"
#include "split/split_overlaps.hpp"

namespace lsgp {

namespace {

// Additional cost of cuts without a mirror image where cuts are symmetric.
constexpr double cost_of_one_side = 4;
// The share of a square that islands alike on both sides may take, relative to that of islands cut only to fill it.
constexpr double most_demand = 1.05;
// Regrouped maps that are kept, and whose pieces make room for others.
constexpr std::size_t most_regrouped = 3;
// No saved island is worth symmetry: by no more than this may its cuts without an image be longer.
constexpr double least_one_sided = 0.01;

// A division of a map.
struct Division {
  MapParts parts;
  DivisionPrice price;
  double one_sided;  // length of cuts without an image, where there is a mirror plane, in square roots of the area
  double cost() const { return price.total() + cost_of_one_side * one_sided; }
};

// The islands of a division, each with its parts where they meet.
struct IslandLayout {
  Eigen::VectorXcd corners;
  PerTriangle<Index> island;
  Index count;
};

IslandLayout lay_out(const HalfedgeMesh& mesh, const ComponentMap& map, const MapParts& parts) {
  IslandLayout out{at_corners(map.cut_mesh, map.position), {}, 0};
  for (Index h = 0; h < mesh.halfedge_count(); ++h) out.corners[h] = parts.motion[parts.part[h / 3]](out.corners[h]);
  out.count = label_parts(mesh, parts.open, out.island);
  return out;
}

// Whether an island of a division overlaps itself.
bool has_own_overlap(const HalfedgeMesh& mesh, const ComponentMap& map, const MapParts& parts) {
  IslandLayout layout = lay_out(mesh, map, parts);
  PerHalfedge<Index> twin = mesh.twin;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (parts.open[h]) twin[h] = none;
  }
  return has_overlap_within(layout.island, std::move(layout.corners), twin);
}

// The area of the square that the islands of a division occupy.
double demand(const SharedSquare& square, const IslandLayout& layout) {
  PerPart<Array<Complex>> points(static_cast<std::size_t>(layout.count));
  for (Index h = 0; h < layout.corners.size(); ++h) {
    points[layout.island[h / 3]].push_back(square.scale * layout.corners[h]);
  }
  const DivisionSearch search(square);
  double out = 0;
  for (const Array<Complex>& own : points) {
    out += search.demand(Support(convex_hull(Eigen::Map<const Eigen::VectorXcd>(own.data(), ssize(own)))));
  }
  return out;
}

// The constraints on splitting a map, and the cost of a division.
class SplitRules {
 public:
  SplitRules(const OpenedSurface& surface, const SplitTask& task, const ComponentMap& map)
      : surface_(surface), kept_(task.kept), factor_(relative_cut_factors(surface.mesh)) {
    // Marked seams, straight cuts and pinned islands stay as they are.
    may_recut_ = map.rotation && !map.has_straight_cuts && map.pins.empty() && !map.cut_graph.cuts.empty() &&
                 std::find(kept_.begin(), kept_.end(), 1) == kept_.end();
    const bool has_images = may_recut_ && map.validity.flipped.empty() && are_mirrored(task.mirroring, map.cones);
    if (has_images) mirrored_.emplace(surface, task.mirroring);
    if (!factor_.empty()) by_length_ = weighing_length(surface.mesh);
  }

  const OpenedSurface& surface() const { return surface_; }
  const PerHalfedge<char>& kept() const { return kept_; }
  bool may_recut() const { return may_recut_; }
  // The surface, and where cuts have costs once more with their length weighed as well.
  Array<MetricMesh> weighings() const {
    Array<MetricMesh> out{surface_};
    if (by_length_) out.push_back({*by_length_, surface_.geometry});
    return out;
  }
  bool is_mirrored() const { return mirrored_.has_value(); }
  const PerHalfedge<double>& factor() const { return factor_; }
  double least_cost(const PerHalfedge<char>& ends) const { return price_of_division(surface_, factor_, ends).total(); }
  Division division(MapParts parts) const {
    const double one_sided = mirrored_ ? mirrored_->one_sided_length(parts.open) : 0;
    const DivisionPrice price = price_of_division(surface_, factor_, parts.open);
    return {std::move(parts), price, one_sided / std::sqrt(surface_.geometry.total_area)};
  }

  // The symmetric divisions made from either side of one, if there is a mirror plane.
  Array<MapParts> mirror(const ComponentMap& map, const PerHalfedge<char>& open) const {
    Array<MapParts> out;
    if (!mirrored_) return out;
    for (const MirrorSide side : {MirrorSide::own, MirrorSide::other}) {
      out.push_back(mirrored_->along_side(map, open, side));
    }
    return out;
  }

  // A division of a map, or a symmetric one made from one of its sides or both.
  // may_replace: whether a symmetric division may replace the other one.
  Division cheapest(const ComponentMap& map, MapParts parts,
                    const std::function<bool(const MapParts&)>& may_replace) const {
    Array<MapParts> mirrored = mirror(map, parts.open);
    if (mirrored_) {
      mirrored.push_back(mirrored_->along_both(map, parts.open));
      if (auto led = mirrored_->along_plane(map, parts.open)) mirrored.push_back(std::move(*led));
    }
    Division best = division(std::move(parts));
    for (MapParts& symmetric : mirrored) {
      Division other = division(std::move(symmetric));
      if (other.cost() < best.cost() && !has_own_overlap(surface_.mesh, map, other.parts) && may_replace(other.parts))
        best = std::move(other);
    }
    return best;
  }

 private:
  const OpenedSurface surface_;
  const PerHalfedge<char>& kept_;     // may not be closed
  const PerHalfedge<double> factor_;  // of edges as cuts
  std::optional<HalfedgeMesh> by_length_;
  bool may_recut_;
  std::optional<MirroredIslands> mirrored_;
};

// The candidate divisions of a map that overlaps itself.
class MapDivider {
 public:
  // ends: where the map is open, cuts included.
  MapDivider(const SplitRules& rules, const PerHalfedge<char>& ends, const ComponentMap& map, ProgressMonitor& monitor)
      : rules_(rules),
        ends_(ends),
        map_(map),
        monitor_(monitor),
        overlaps_(find_own_overlaps({rules.surface(), ends}, map)),
        open_(ends) {
    for (const Index h : overlaps_.ends) open_[h] = open_[rules.surface().mesh.twin[h]] = 1;
  }

  bool is_whole() const { return overlaps_.empty(); }
  double cost_before() const { return rules_.least_cost(ends_); }

  // costs: the surface, with the costs of further cuts.
  Division divide(CutCost rule, const MetricMesh& costs) const {
    const HalfedgeMesh& mesh = rules_.surface().mesh;
    MapParts parts{open_, {}, {}};
    const auto before_cut = [&] { monitor_.advance(0); };
    const Array<Index> opened = split_overlaps({costs, open_}, overlaps_.pairs, rule, before_cut);
    for (const Index h : opened) parts.open[h] = parts.open[mesh.twin[h]] = 1;
    parts.motion.resize(label_parts(mesh, parts.open, parts.part));
    if (map_.rotation) merge_islands(rules_.surface(), map_, rules_.kept(), parts);
    return rules_.cheapest(map_, std::move(parts), [](const MapParts&) { return true; });
  }

 private:
  const SplitRules& rules_;
  const PerHalfedge<char>& ends_;
  const ComponentMap& map_;
  ProgressMonitor& monitor_;
  const OwnOverlaps overlaps_;
  PerHalfedge<char> open_;  // where the map or a piece of it ends
};

// Where a map is open: where it was before, and along its cuts.
PerHalfedge<char> ends_of(const OpenedSurface& surface, const ComponentMap& map) {
  PerHalfedge<char> ends = surface.open;
  for (std::size_t h = 0; h < ends.size(); ++h) ends[h] = ends[h] || map.cut_graph.is_cut[h];
  return ends;
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

// The cheapest division of maps that differ by their cuts.
class WaySearch {
 public:
  WaySearch(const SplitRules& rules, ProgressMonitor& monitor) : rules_(rules), monitor_(monitor) {}

  // Divides a map unless that costs at least as much as what was found so far.  way: must outlive this object.
  // weighings: the surface with each of the costs that further cuts may have.  least: dividing an overlapping layout is
  // assumed to add at least this cost.
  void divide(const ComponentMap& way, const Array<CutCost>& rules, const Array<MetricMesh>& weighings, double least);

  // Regroups the islands of the divided maps, the cheapest first, until one map is a single island.
  void regroup_divided();
  // Whether there is a division that leaves one island.
  bool leaves_one() const { return is_one(best_) || std::any_of(of_regrouped_.begin(), of_regrouped_.end(), is_one); }

  // The cheapest map, with pieces that made room for others if it has several islands.
  ComponentMap best();

 private:
  // A map and its division.
  struct Divided {
    const ComponentMap* map;
    Division division;
  };

  static void sort_by_cost(Array<Divided>& divided) {
    std::stable_sort(divided.begin(), divided.end(),
                     [](const Divided& a, const Divided& b) { return a.division.cost() < b.division.cost(); });
  }
  static bool is_one(const Divided& divided) { return divided.division.price.islands == 1; }
  // Other islands of a divided map, if that pays.
  void regroup_islands(const Divided& divided, Regrouping steps);
  bool pays(const Division& other) const {
    const Division& now = best_.division;
    const Index saved = now.price.islands - other.price.islands;
    return saved > 0 && other.cost() < now.cost() && other.one_sided <= now.one_sided + least_one_sided &&
           other.price.cuts <= now.price.cuts + cuts_for_island * static_cast<double>(saved);
  }

  const SplitRules& rules_;
  ProgressMonitor& monitor_;
  Array<Divided> waiting_;  // to be regrouped
  std::deque<ComponentMap> regrouped_;
  Array<Divided> of_regrouped_;
  Divided best_{nullptr, {}};
};

void WaySearch::divide(const ComponentMap& way, const Array<CutCost>& rules, const Array<MetricMesh>& weighings,
                       double least) {
  const PerHalfedge<char> ends = ends_of(rules_.surface(), way);
  const MapDivider divider(rules_, ends, way, monitor_);
  const double least_cost = divider.cost_before() + (divider.is_whole() ? 0 : least);
  for (const CutCost rule : rules) {
    for (const MetricMesh& costs : weighings) {
      if (best_.map != nullptr && least_cost >= best_.division.cost()) return;
      Divided found{&way, divider.divide(rule, costs)};
      if (best_.map == nullptr || found.division.cost() < best_.division.cost()) best_ = found;
      if (rules_.may_recut()) waiting_.push_back(std::move(found));
    }
  }
}

void WaySearch::regroup_divided() {
  sort_by_cost(waiting_);
  for (const Divided& divided : waiting_) {
    if (is_one(best_)) break;
    regroup_islands(divided, Regrouping::direct);
  }
  waiting_.clear();
}

void WaySearch::regroup_islands(const Divided& divided, Regrouping steps) {
  monitor_.advance(0);
  ComponentMap map = *divided.map;
  apply(rules_.surface(), divided.division.parts, map);
  std::optional<ComponentMap> other = regroup(rules_.surface(), rules_.factor(), steps, map);
  if (!other) return;
  const PerHalfedge<char> ends = ends_of(rules_.surface(), *other);
  regrouped_.push_back(std::move(*other));
  Divided found{&regrouped_.back(),
                MapDivider(rules_, ends, regrouped_.back(), monitor_).divide(CutCost::shortest, rules_.surface())};
  if (pays(found.division)) best_ = found;
  of_regrouped_.push_back(std::move(found));
}

ComponentMap WaySearch::best() {
  Array<Divided> direct = std::move(of_regrouped_);
  of_regrouped_.clear();
  sort_by_cost(direct);
  direct.resize(std::min(direct.size(), most_regrouped));
  for (const Divided& divided : direct) {
    if (is_one(best_)) break;
    if (!is_one(divided)) regroup_islands(divided, Regrouping::detours);
  }
  ComponentMap out = *best_.map;
  apply(rules_.surface(), best_.division.parts, out);
  return out;
}

// Maps with the same cuts are alike but for a motion.
void add_if_new(Array<ComponentMap>& ways, ComponentMap way) {
  const auto has_same_cuts = [&](const ComponentMap& other) { return other.cut_graph.is_cut == way.cut_graph.is_cut; };
  if (std::none_of(ways.begin(), ways.end(), has_same_cuts)) ways.push_back(std::move(way));
}

// Maps with other cuts for the same cones, and those that are like one of them on one side of a mirror plane.
Array<ComponentMap> find_ways(const SplitRules& rules, const ComponentMap& map) {
  Array<ComponentMap> ways;
  if (!rules.may_recut()) return ways;
  const Array<MetricMesh> weighings = rules.weighings();
  for (auto sought = weighings.begin(); sought != weighings.end(); ++sought) {
    // Cuts sought by their length as well are not exchanged by cost alone.
    const Array<MetricMesh> costs(sought, weighings.end());
    for (ComponentMap& way : recut(*sought, costs, map)) add_if_new(ways, std::move(way));
  }
  for (std::size_t i = 0, count = ways.size(); i < count; ++i) {
    for (const MapParts& parts : rules.mirror(ways[i], ways[i].cut_graph.is_cut)) {
      ComponentMap way = ways[i];
      apply(rules.surface(), parts, way);
      way.required_cuts = halfedges_of(way.cut_graph);
      add_if_new(ways, std::move(way));
    }
  }
  return ways;
}

}  // namespace

bool split_map(const OpenedSurface& surface, const SplitTask& task, ProgressMonitor& monitor, ComponentMap& map) {
  const ProgressMonitor::Stage stage(monitor, "split");
  if (!overlaps_itself(surface.mesh, map)) return false;
  const SplitRules rules(surface, task, map);
  // The fastest rule selects among the recut maps. The map's own cuts compete with others, so that recutting never
  // costs more. All divisions are judged by the given costs of cuts, those found by length as well.
  const Array<ComponentMap> ways = find_ways(rules, map);
  const Array<MetricMesh> weighings = rules.weighings();
  WaySearch search(rules, monitor);
  for (const ComponentMap& way : ways) search.divide(way, {CutCost::shortest}, {surface}, cost_of_island);
  search.divide(map, {CutCost::shortest, CutCost::no_slivers}, weighings, 0);
  search.regroup_divided();
  if (!search.leaves_one()) {
    search.divide(map, {CutCost::no_small_parts}, weighings, 0);
    search.regroup_divided();
  }
  map = search.best();
  return true;
}

void restore_symmetry(const OpenedSurface& surface, const SplitTask& task, const SharedSquare& square,
                      ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  MapParts parts{ends_of(surface, map), {}, {}};
  parts.motion.resize(label_parts(mesh, parts.open, parts.part));
  const SplitRules rules(surface, task, map);
  const double most = rules.is_mirrored() ? most_demand * demand(square, lay_out(mesh, map, parts)) : 0;
  const auto fills_as_well = [&](const MapParts& other) { return demand(square, lay_out(mesh, map, other)) <= most; };
  apply(surface, rules.cheapest(map, std::move(parts), fills_as_well).parts, map);
}

}  // namespace lsgp
