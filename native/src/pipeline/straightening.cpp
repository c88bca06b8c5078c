// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/straightening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plane/overlaps.hpp"
#include "repair/straighten.hpp"
#include "transitions/holonomy.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// The largest bend of sides that are straightened, radians; the smaller, the closer the map is to an isometry, whose
// angles are those of the surface up to the precision of the file.
double most_bend(double l2) {
  constexpr double widest = 10 * M_PI / 180, beside_stretch = 30, rounding = 1e-3;
  return std::min(widest, rounding + beside_stretch * std::sqrt(std::max(0.0, l2 - 1)));
}

// The L2 stretch that straight sides may cost: hardly any more if the map is isometric.
double largest_l2_straight(double l2) {
  constexpr double share = 0.1, least = 0.002, most_times = 20, rounding = 1e-6;
  const double excess = std::max(0.0, l2 - 1);
  return l2 + std::min(std::max(share * excess, least), most_times * excess) + rounding;
}

double l2_of(const CutSurface& surface, const ComponentMap& map) {
  return l2_stretch(surface.geometry, measure_jacobians(surface, surface.cut_mesh, map.position));
}

// Whether an island of the layout overlaps itself. The sides of a cut that coincide may cross by rounding, so where the
// boundary tells of an overlap the triangles decide.
bool overlaps(const CutSurface& surface, const ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<Index> twin = mesh.twin;
  PerTriangle<Index> part;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_open(mesh, surface.cut_mesh, h)) twin[h] = none;
  }
  label_parts(mesh, surface.cut_graph.is_cut, part);
  const Eigen::VectorXcd corners = side_by_side(part, at_corners(surface.cut_mesh, map.position));
  return !find_few_overlaps(corners, twin, 0, {});
}

// Whether all cuts are connected, boundaries included, so that each can be related to the others.
bool is_one_network(const CutSurface& surface) {
  const NodeGraph nodes = build_node_graph(surface.mesh, surface.cut_graph, [](Index) { return 0.0; });
  return nodes.order.size() == nodes.vertex.size();
}

// Of all marked features.
double marked_length(const CutSurface& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  double out = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.feature[h] && h > mesh.twin[h]) out += surface.geometry.length[h];
  }
  return out;
}

// Straightens all sides at once, or else as many as possible: halves that fail are divided again. Marked features,
// which may cost more, come first.
class SideSearch {
 public:
  SideSearch(const StraighteningTask& task, const ComponentMap& map, SideKinds kinds, StraightSides straight)
      : task_(task),
        map_(map),
        order_(sort_by_cost(straight)),
        sides_(std::move(straight.sides)),
        straight_(std::move(straight)),
        most_growth_for_marked_(kinds == SideKinds::of_strip ? most_growth_of_strip : most_growth_of_features),
        most_l2_(largest_l2_straight(map.natural_l2)),
        may_overlap_(overlaps(task.surface, map)) {
    straight_.sides.clear();
  }

  std::optional<ComponentMap> search() {
    constexpr int for_marked = 40, for_others = 10, at_least = 2;
    constexpr int work = 300000;  // triangles of the maps that are tried for sides that are not marked
    if (order_.marked > 0) {
      const double least_l2 = most_l2_;
      most_l2_ = std::max(least_l2, most_growth_for_marked_ * map_.natural_l2);
      left_ = for_marked;
      keep_straight();
      add(order_.straight, order_.marked, false);
      most_l2_ = least_l2;
      if (best_) most_l2_ = std::max(least_l2, largest_l2_straight(l2_of(task_.surface, *best_)));
    }
    left_ = std::clamp(work / task_.surface.mesh.triangle_count(), at_least, for_others);
    const std::ptrdiff_t all = ssize(sides_);
    if (order_.marked < all && tries(order_.marked, all)) {
      const bool has_border = add(order_.marked, order_.border, order_.border == all);
      add(order_.border, all, has_border);
    }
    if (!straight_.reasons.empty()) {
      if (!best_) best_ = map_;
      best_->release_reasons = straight_.reasons;
    }
    return std::move(best_);
  }

  // Of marked features that are straight.
  double marked_length() const { return straight_.marked_length(); }

 private:
  // Of the L2 stretch, for marked features.
  static constexpr double most_growth_of_features = 1.1;
  // What a straight strip costs is weighed later, against other maps of its tube: here it may be whatever tubes can
  // need. By the formula for bends (docs/how-to/hard-surfaces.md) it is 2 for one whose radius is 0.99999 of its
  // bend's.
  static constexpr double most_growth_of_strip = 2;

  // Marked features that are straight already stay so, whatever they have cost.
  void keep_straight() {
    if (order_.straight == 0) return;
    StraightSides straight = straight_;
    straight.sides.assign(sides_.begin(), sides_.begin() + order_.straight);
    ComponentMap kept = with(straight, map_);
    if (kept.validity.defects() > 0) return;
    most_l2_ = std::max(most_l2_, l2_of(task_.surface, kept));
    straight_ = std::move(straight);
    best_ = std::move(kept);
  }

  // The map with these sides, sought from the original one or one that is turned already.  Throws SOLVER_FAILED.
  ComponentMap with(const StraightSides& sides, const ComponentMap& start) const {
    ComponentMap out = map_;
    const auto& [surface, connection, options, before_step] = task_;
    StraightSides turned = sides;
    if (&start != &map_) turned.turn = 1;
    out.position = straighten(surface, {connection, map_.curvature}, options, before_step, {start.position, turned});
    check_positions(surface.mesh, out);
    return out;
  }

  // Adds sides to those that are straight, as far as that succeeds.  is_known_to_fail: with all of them.  Returns
  // whether it did with all of them.
  bool add(std::ptrdiff_t begin, std::ptrdiff_t end, bool is_known_to_fail) {
    if (begin == end || left_ == 0) return false;
    if (!is_known_to_fail) {
      const std::optional<ReleaseReason> reason = tries(begin, end);
      if (!reason) return true;
      release(begin, end, *reason);
    }
    const std::ptrdiff_t count = end - begin;
    const std::ptrdiff_t smallest = end <= order_.marked ? 1 : std::max<std::ptrdiff_t>(1, ssize(sides_) / 16);
    if (count <= smallest) return false;
    const bool has_first = add(begin, begin + count / 2, false);
    add(begin + count / 2, end, has_first);
    return false;
  }

  void release(std::ptrdiff_t begin, std::ptrdiff_t end, ReleaseReason reason) {
    for (std::ptrdiff_t i = begin; i < std::min(end, order_.marked); ++i) {
      for (const Index h : sides_[i].halfedges) straight_.reasons[h] = reason;
    }
  }

  // None if these sides are straight then, as well; otherwise why they are not. Features that bend much are found
  // beside those that are straight, or else from the map as it was.
  std::optional<ReleaseReason> tries(std::ptrdiff_t begin, std::ptrdiff_t end) {
    --left_;
    StraightSides more = straight_;
    more.sides.insert(more.sides.end(), sides_.begin() + begin, sides_.begin() + end);
    std::optional<ReleaseReason> reason = ReleaseReason::contradiction;
    if (best_ && end <= order_.marked) reason = tries_from(*best_, more);
    if (reason == ReleaseReason::contradiction) reason = tries_from(map_, more);
    if (!reason) straight_ = std::move(more);
    return reason;
  }

  std::optional<ReleaseReason> tries_from(const ComponentMap& start, const StraightSides& sides) {
    std::optional<ComponentMap> tried;
    try {
      tried = with(sides, start);
    } catch (const Error& error) {
      if (error.code() != Code::solver_failed) throw;
      return ReleaseReason::contradiction;
    }
    if (tried->validity.defects() > 0) return ReleaseReason::contradiction;
    if (l2_of(task_.surface, *tried) > most_l2_) return ReleaseReason::stretch;
    if (!may_overlap_ && overlaps(task_.surface, *tried)) return ReleaseReason::contradiction;
    best_ = std::move(tried);
    return std::nullopt;
  }

  const StraighteningTask& task_;
  const ComponentMap& map_;
  const SideOrder order_;
  const Array<StraightSide> sides_;      // the cheapest first
  StraightSides straight_;               // with the sides that are straight
  const double most_growth_for_marked_;  // of the L2 stretch
  double most_l2_;
  const bool may_overlap_;
  int left_ = 0;  // attempts
  std::optional<ComponentMap> best_;
};

}  // namespace

std::optional<StraightSides> sides_to_straighten(const CutSurface& surface, const ComponentMap& map, SideKinds kinds,
                                                 LineReading reading) {
  StraightSides straight = find_straight_sides(surface, *map.rotation, map.position,
                                               {most_bend(map.natural_l2), kinds == SideKinds::with_creases,
                                                kinds == SideKinds::marked || kinds == SideKinds::of_strip, reading});
  if (!straight.reasons.empty()) return straight;
  if (straight.sides.empty() || (!straight.is_bent() && !straight.has_axes)) return std::nullopt;
  return straight;
}

std::optional<ComponentMap> with_straight_sides(const StraighteningTask& task, const ComponentMap& map, SideKinds kinds,
                                                StraightSides straight) {
  constexpr double rounding = 1e-9;    // of lengths
  constexpr double least_gain = 0.03;  // of the marked length: a small one may be lost when islands are straightened
  const bool has_marked = !straight.reasons.empty();
  const double all = has_marked ? marked_length(task.surface) : 0;
  Array<Array<StraightSide>> tried{straight.sides};
  SideSearch search(task, map, kinds, std::move(straight));
  std::optional<ComponentMap> best = search.search();
  if (kinds == SideKinds::of_strip) return best;
  double most = search.marked_length();
  for (const LineReading reading : {LineReading::opened, LineReading::divided}) {
    if (most >= all * (1 - rounding)) break;
    std::optional<StraightSides> other = sides_to_straighten(task.surface, map, kinds, reading);
    if (!other || std::find(tried.begin(), tried.end(), other->sides) != tried.end()) continue;
    tried.push_back(other->sides);
    SideSearch again(task, map, kinds, std::move(*other));
    std::optional<ComponentMap> found = again.search();
    if (!(again.marked_length() > most + least_gain * all)) continue;
    most = again.marked_length();
    best = std::move(found);
  }
  return best;
}

void straighten_islands(const MetricMesh& surface, SideKinds kinds, const StretchOptions& options,
                        const StepHook& before_step, ComponentMap& map) {
  const CutSurface opened{surface, map.cut_graph, map.cut_mesh};
  if (map.natural_l2 == 0 || !is_one_network(opened)) return;
  const LineReading reading = kinds == SideKinds::of_strip ? LineReading::whole : LineReading::nearest;
  std::optional<StraightSides> sides = sides_to_straighten(opened, map, kinds, reading);
  if (!sides) return;
  const ParallelTransport connection = connection_of_map(opened, map.curvature, *map.rotation, map.position);
  std::optional<ComponentMap> straight =
      with_straight_sides({opened, connection, options, before_step}, map, kinds, std::move(*sides));
  if (straight) map = std::move(*straight);
}

HalfedgeMesh with_marked_sides(const HalfedgeMesh& mesh, const ComponentMap& map) {
  HalfedgeMesh out = mesh;
  out.feature.resize(mesh.halfedge_count());
  out.is_feature_junction.assign(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) out.feature[h] = is_open(mesh, map.cut_mesh, h);
  for (const Cut& cut : map.cut_graph.cuts) out.is_feature_junction[cut.tail] = out.is_feature_junction[cut.head] = 1;
  return out;
}

}  // namespace lsgp
