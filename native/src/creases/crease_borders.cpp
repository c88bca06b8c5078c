// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/crease_borders.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/conditions.hpp"
#include "base/least_first.hpp"
#include "base/union_find.hpp"
#include "creases/bevels.hpp"
#include "creases/features.hpp"
#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

constexpr double least_patch = 0.0002;       // of the area: smaller ones are no islands
constexpr double quarter_turns = 4;          // of the curvature of closed surfaces, by Euler characteristic
constexpr double least_beside_apexes = 0.5;  // of the curvature, where the others carry the rest
constexpr double most_apexes = 2;            // few enough to be cones
constexpr double least_on_bevels = 0.98;     // and creases: what is round everywhere has as much on what is narrow
constexpr double most_dead_ends = 0.1;       // of the vertices at creases: those of what is round and coarse fade out
constexpr double is_curved = 0.06;           // radians at a vertex
constexpr double is_bent = 0.25;             // radians along a border that two patches share
constexpr double least_shared = 0.08;        // of the smaller patch's perimeter, to be unfolded with it
constexpr double same_share = 1e-9;          // of it, relatively: what differs by less is rounding
constexpr double widest_corner = 2 * M_PI / 3;  // radians, at the ends of a whole side
constexpr double is_no_hole = 0.35;             // radians between a border's turning and that of a hole in the plane
constexpr Index borders_of_frame = 3;           // a tube has two
constexpr double least_across_frame = 0.5;      // bend of what divides it, of that of a crease
constexpr double operations_an_entry = 100;     // of a queue

bool is_inside(const HalfedgeMesh& mesh, Index v) { return mesh.loop_of_vertex[v] == none; }

// The patch of every triangle; those with less than this share of the area are merged with the neighbor across the
// longest and flattest border.
PerTriangle<Index> find_patches(const MetricMesh& surface, const PerHalfedge<char>& crease, const Eigen::VectorXd& bend,
                                double least_share) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  PerTriangle<Index> patch;
  const Index count = label_parts(mesh, crease, patch);
  PerPart<double> area(count, 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[patch[f]] += geometry.area[f];
  PerPart<std::map<Index, double>> shared(count);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none) continue;
    const Index here = patch[h / 3], there = patch[mesh.twin[h] / 3];
    if (here != there) shared[here][there] += geometry.length[h] * std::cos(bend[h] / 2);
  }
  UnionFind joined(count);
  PerPart<Index> home(count);  // the patch that stands for a merged set
  for (Index p = 0; p < count; ++p) home[p] = p;
  // Where Gauss-Bonnet asks for more cones than can be placed, everything has to end at creases.
  const bool takes_cones = !mesh.closed() || quarter_turns * std::abs(mesh.euler) <= most_conditions;
  const double least_area = takes_cones ? least_share * geometry.total_area : 0;
  using Entry = std::pair<double, Index>;
  LeastFirst<Entry> smallest;
  for (Index p = 0; p < count; ++p) smallest.emplace(area[p], p);
  while (!smallest.empty() && smallest.top().first < least_area) {
    checkpoint(operations_an_entry);
    const auto [size, p] = smallest.top();
    smallest.pop();
    if (home[joined.find(p)] != p || size != area[p] || shared[p].empty()) continue;
    const Index q = std::max_element(shared[p].begin(), shared[p].end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
    for (const auto& [r, length] : shared[p]) {
      shared[r].erase(p);
      if (r == q) continue;
      shared[q][r] += length;
      shared[r][q] += length;
    }
    joined.unite(p, q);
    home[joined.find(q)] = q;
    area[q] += area[p];
    smallest.emplace(area[q], q);
  }
  for (Index& p : patch) p = home[joined.find(p)];
  return patch;
}

// What two patches share of a border, from one vertex of curvature or of other borders to the next.
struct SharedBorder {
  Array<Index> halfedges;
  Index here, there;  // the patches
  double length = 0;
  double curvature = 0;  // of the vertices between its ends, without signs
  bool closed = false;
};

class Patches {
 public:
  // darts: edges inside patches at which these are open as well, or empty.
  Patches(const MetricMesh& surface, PerTriangle<Index> patch, Bevels bevels, const PerHalfedge<char>& darts = {})
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        patch_(std::move(patch)),
        bevels_(std::move(bevels)),
        is_border_(surface.mesh.halfedge_count(), 0) {
    const HalfedgeMesh& mesh = surface.mesh;
    const Geometry& geometry = surface.geometry;
    degree_.assign(mesh.vertex_count(), 0);
    perimeter_.assign(mesh.triangle_count(), 0);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      is_border_[h] = mesh.twin[h] == none || patch_[h / 3] != patch_[mesh.twin[h] / 3] || (!darts.empty() && darts[h]);
      if (!is_border_[h]) continue;
      perimeter_[patch_[h / 3]] += geometry.length[h];
      if (mesh.twin[h] < h) ++degree_[mesh.origin(h)], ++degree_[mesh.target(h)];
    }
  }

  // Whether so much of the curvature lies where patches meet or at bevels, and at more than most_corners. Less is
  // enough where the others are the apexes of cones.
  bool carry_curvature(double least_share, Index most_corners) const {
    const CreaseCurvature found = curvature();
    if (!found.is_curved() || std::max(found.vertex_count(), found.vertex_count_at_creases()) <= most_corners) {
      return false;
    }
    if (found.is_carried(least_share)) return true;
    return found.is_carried(least_beside_apexes) && found.vertex_count_elsewhere() <= most_apexes;
  }

  // Whether so many vertices inside the patches have curvature that they cannot all be cones.
  bool take_too_many_cones() const { return curvature().vertex_count_elsewhere() > most_conditions; }

  const Bevels& bevels() const { return bevels_; }

  // The borders that are left when patches are unfolded together, those with the largest share of a perimeter first, if
  // that makes fewer islands also apart at notches.
  PerHalfedge<char> unfold_together() const {
    Array<SharedBorder> borders = trace();
    sort_by_share(borders);
    const PerHalfedge<char> nowhere(mesh_.halfedge_count(), 0);
    Unfolded together = unfold(borders, nowhere), apart = unfold(borders, find_notches());
    return std::move(apart.joined > together.joined ? apart.open : together.open);
  }

 private:
  CreaseCurvature curvature() const {
    PerVertex<char> there = bevels_.is_rounded;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) there[v] = there[v] || degree_[v] > 0;
    return CreaseCurvature({mesh_, geometry_}, there);
  }

  struct Unfolded {
    PerHalfedge<char> open;
    Index joined;  // by how many there are fewer islands, about, once none lies over itself around a vertex
  };

  // The largest first; those that differ by rounding, as on regular outlines, as they are.
  void sort_by_share(Array<SharedBorder>& borders) const {
    Array<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < borders.size(); ++i) order.emplace_back(-share(borders[i]), i);
    std::sort(order.begin(), order.end());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && order[end].first <= (1 - same_share) * order[begin].first) ++end;
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end),
                [](const auto& a, const auto& b) { return a.second < b.second; });
    }
    Array<SharedBorder> sorted;
    for (const auto& [share, i] : order) sorted.push_back(std::move(borders[i]));
    borders = std::move(sorted);
  }

  // Of the smaller patch's perimeter.
  double share(const SharedBorder& border) const {
    return border.length / std::min(perimeter_[border.here], perimeter_[border.there]);
  }

  // borders: the first ones are joined before others.  is_apart: those that stay open.
  Unfolded unfold(const Array<SharedBorder>& borders, const PerHalfedge<char>& is_apart) const {
    UnionFind islands(mesh_.triangle_count());
    Unfolded out{is_border_, 0};
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) out.open[h] = out.open[h] && mesh_.twin[h] != none;
    for (const SharedBorder& border : borders) {
      if (border.closed || border.curvature > is_bent) continue;
      if (share(border) < least_shared && !is_whole_side(border)) continue;
      if (is_apart[border.halfedges.front()] || is_apart[border.halfedges.back()]) continue;
      if (!islands.unite(border.here, border.there)) continue;
      ++out.joined;
      for (const Index h : border.halfedges) out.open[h] = out.open[mesh_.twin[h]] = 0;
    }
    Index overlaps = 0;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      Index open = 0;
      if (has_notch(v)) mesh_.for_each_outgoing(v, [&](Index h) { open += out.open[h]; });
      overlaps += open == 1;
    }
    out.joined -= overlaps / 2;  // a border that is opened between two of them serves both
    return out;
  }

  // Whether patches have more than a whole turn around a vertex, and lie over each other where all are unfolded
  // together.
  bool has_notch(Index v) const {
    return degree_[v] >= 3 && is_inside(mesh_, v) && geometry_.angle_defect[v] < -is_curved;
  }

  // Borders, on both sides, beside the largest angle at each notch, such as those of the sides of a star with its caps.
  PerHalfedge<char> find_notches() const {
    PerHalfedge<char> out(mesh_.halfedge_count(), 0);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!has_notch(v)) continue;
      Array<Index> begin;  // of the angles, counter-clockwise
      Array<double> angle;
      mesh_.for_each_outgoing(v, [&](Index h) {
        if (!is_border_[h]) return;
        begin.push_back(h);
        angle.push_back(angle_from(h));
      });
      const auto widest = std::max_element(angle.begin(), angle.end()) - angle.begin();
      for (const Index g : {begin[widest], begin[(widest + 1) % ssize(begin)]}) out[g] = out[mesh_.twin[g]] = 1;
    }
    return out;
  }

  // The angle of a patch at the origin of a border's halfedge, on its left.
  double angle_from(Index h) const {
    double out = 0;
    do {
      out += geometry_.angle[h];
      h = mesh_.rotate(h);
    } while (h != none && !is_border_[h]);
    return out;
  }

  // Whether a border is a side of both patches from corner to corner, such as the ends of two strips.
  bool is_whole_side(const SharedBorder& border) const {
    const Index first = border.halfedges.front(), last = border.halfedges.back();
    const Index corners[] = {first, after(last), mesh_.twin[last], after(mesh_.twin[first])};
    return std::all_of(std::begin(corners), std::end(corners), [&](Index h) { return angle_from(h) < widest_corner; });
  }

  bool is_node(Index v) const {
    return degree_[v] != 2 || !is_inside(mesh_, v) || std::abs(geometry_.angle_defect[v]) > is_curved;
  }

  // The border's halfedge that goes on where h ends, at a vertex that is no node.
  Index after(Index h) const {
    Index g = next(h);
    while (!is_border_[g]) g = next(mesh_.twin[g]);
    return g;
  }

  SharedBorder follow(Index first) const {
    SharedBorder out{{}, patch_[first / 3], patch_[mesh_.twin[first] / 3]};
    Index h = first;
    while (true) {
      out.halfedges.push_back(h);
      out.length += geometry_.length[h];
      const Index v = mesh_.target(h);
      if (is_node(v)) return out;
      out.curvature += std::abs(geometry_.angle_defect[v]);
      h = after(h);
      out.closed = h == first;
      if (out.closed) return out;
    }
  }

  // Every shared border once.
  Array<SharedBorder> trace() const {
    Array<SharedBorder> out;
    PerHalfedge<char> done(mesh_.halfedge_count(), 0);
    const auto add = [&](Index h) {
      if (done[h] || !is_border_[h] || mesh_.twin[h] == none) return;
      out.push_back(follow(h));
      for (const Index g : out.back().halfedges) done[g] = done[mesh_.twin[g]] = 1;
    };
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (is_node(mesh_.origin(h))) add(h);
    }
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) add(h);  // those without a node
    return out;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  PerTriangle<Index> patch_;
  Bevels bevels_;
  PerHalfedge<char> is_border_;  // of patches, the mesh's own borders among them
  PerVertex<Index> degree_;      // borders between patches at each vertex
  Array<double> perimeter_;      // of patches
};

// The borders of the islands that open edges make.
struct Loops {
  PerTriangle<Index> island;
  PerHalfedge<Index> at_corner;  // the loop through a corner, none inside
  Array<double> turning;         // of each loop, radians: 2 pi around a disk, -2 pi around a hole in the plane
  Array<Index> of;               // the island of each loop
};

Loops find_loops(const MetricMesh& surface, const PerHalfedge<char>& open) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const auto ends = [&](Index h) { return open[h] || mesh.twin[h] == none; };
  Loops out;
  label_parts(mesh, open, out.island);
  out.at_corner.assign(mesh.halfedge_count(), none);
  for (Index first = 0; first < mesh.halfedge_count(); ++first) {
    if (!ends(first) || out.at_corner[first] != none) continue;
    const Index loop = static_cast<Index>(out.turning.size());
    double turning = 0;
    Index h = first;
    do {
      turning += M_PI;
      Index g = next(h);
      for (;; g = next(mesh.twin[g])) {
        out.at_corner[g] = loop;
        turning -= geometry.angle[g];
        if (ends(g)) break;
      }
      h = g;
    } while (h != first);
    out.turning.push_back(turning);
    out.of.push_back(out.island[first / 3]);
  }
  return out;
}

// Loops along the middle of a bevel turn as those beside it, on their side: a bevel is narrow, and the faces that it
// ends are flattened with their half of it, hardly stretched.
void turn_beside_bevels(const MetricMesh& surface, const PerHalfedge<char>& on_bevel, const PerHalfedge<char>& open,
                        Loops& loops) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerVertex<char> is_reached(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (loops.at_corner[h] != none) is_reached[mesh.origin(h)] = 1;
  }
  Array<std::pair<Index, Index>> beside;  // vertices of the bevel's near side, and their loops
  const auto reach_from = [&](Index h, Index loop) {
    const Index v = mesh.target(h);
    if (!on_bevel[h] || is_reached[v]) return;
    is_reached[v] = 1;
    beside.emplace_back(v, loop);
  };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (loops.at_corner[h] != none && !open[h]) reach_from(h, loops.at_corner[h]);
  }
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const auto [v, loop] = beside[i];
    loops.turning[loop] += surface.geometry.angle_defect[v];
    mesh.for_each_outgoing(v, [&, at = loop](Index h) { reach_from(h, at); });
  }
}

// Loops that go around no hole in the plane, one for each island that has any: a tube has to be opened from end to end.
Array<Index> find_tubes(const Loops& loops) {
  Array<Index> outer(loops.island.size(), none), tube(loops.island.size(), none), out;
  for (Index l = 0; l < static_cast<Index>(loops.of.size()); ++l) {
    Index& largest = outer[loops.of[l]];
    if (largest == none || loops.turning[l] > loops.turning[largest]) largest = l;
  }
  for (Index l = 0; l < static_cast<Index>(loops.of.size()); ++l) {
    const Index i = loops.of[l];
    if (l == outer[i] || std::abs(loops.turning[l] + 2 * M_PI) <= is_no_hole || tube[i] != none) continue;
    tube[i] = l;
    out.push_back(l);
  }
  return out;
}

// The cheapest path from a loop to another one of its island, halfedges; empty where no cut can run.
Array<Index> cheapest_path_across(const MetricMesh& surface, const Loops& loops, Index loop,
                                  const Array<Index>& corners) {
  const HalfedgeMesh& mesh = surface.mesh;
  std::map<Index, double> distance;                // of vertices inside
  std::map<Index, Index> from;                     // the halfedge that leads there
  using Entry = std::tuple<double, Index, Index>;  // distance, vertex, and the halfedge where it is on another loop
  LeastFirst<Entry> queue;
  const auto step = [&](double before, Index h) {
    if (!may_cut(mesh, h)) return;
    const double after = before + cut_cost(surface, h);
    const Index v = mesh.target(h), met = loops.at_corner[next(h)];
    if (met == loop) return;
    if (met != none) {
      queue.emplace(after, v, h);
      return;
    }
    const auto at = distance.try_emplace(v, std::numeric_limits<double>::infinity()).first;
    if (!(after < at->second)) return;
    at->second = after;
    from[v] = h;
    queue.emplace(after, v, none);
  };
  for (const Index c : corners) step(0, c);
  while (!queue.empty()) {
    checkpoint(operations_an_entry);
    const auto [length, v, last] = queue.top();
    queue.pop();
    if (last != none) {
      Array<Index> path{last};
      for (auto at = from.find(mesh.origin(last)); at != from.end(); at = from.find(mesh.origin(path.back()))) {
        path.push_back(at->second);
      }
      return path;
    }
    if (length > distance[v]) continue;
    mesh.for_each_outgoing(v, [&, before = length](Index h) { step(before, h); });
  }
  return {};
}

void open_tubes(const MetricMesh& surface, const PerHalfedge<char>& on_bevel, PerHalfedge<char>& open) {
  const HalfedgeMesh& mesh = surface.mesh;
  bool found = true;
  while (found) {
    checkpoint(static_cast<double>(mesh.halfedge_count()));
    found = false;
    Loops loops = find_loops(surface, open);
    turn_beside_bevels(surface, on_bevel, open, loops);
    const Array<Index> tubes = find_tubes(loops);
    Array<Array<Index>> corners(loops.of.size());
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const bool ends = open[h] || mesh.twin[h] == none;
      if (loops.at_corner[h] != none && !ends) corners[loops.at_corner[h]].push_back(h);
    }
    for (const Index tube : tubes) {
      for (const Index h : cheapest_path_across(surface, loops, tube, corners[tube])) {
        open[h] = open[mesh.twin[h]] = 1;
        found = true;
      }
    }
  }
}

// Whether the creases of a surface end at other creases or at its borders. Where faces are large, smooth shapes bend by
// as much here and there, along lines that begin and end anywhere. Creases that are marked may end where they like.
bool meet_others(const HalfedgeMesh& mesh, const PerHalfedge<char>& crease, const Eigen::VectorXd& bend, double angle) {
  PerVertex<Index> degree(mesh.vertex_count(), 0), bent(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!crease[h]) continue;
    ++degree[mesh.origin(h)];
    bent[mesh.origin(h)] += bend[h] >= angle;
  }
  Index all = 0, dead_ends = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    all += degree[v] > 0;
    dead_ends += degree[v] == 1 && bent[v] == 1 && is_inside(mesh, v);
  }
  return dead_ends <= most_dead_ends * all;
}

// Creases, and where patches with several borders that go around no hole in the plane, such as the chamfers of a box
// all together, bend from one border to another: opened along a path each they would be branches.
PerHalfedge<char> with_frames_divided(const MetricMesh& surface, PerHalfedge<char> crease, const Eigen::VectorXd& bend,
                                      double angle) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Loops loops = find_loops(surface, crease);
  Array<Index> around_nothing(mesh.triangle_count(), 0);  // of patches
  for (std::size_t l = 0; l < loops.of.size(); ++l) {
    if (std::abs(loops.turning[l] + 2 * M_PI) > is_no_hole) ++around_nothing[loops.of[l]];
  }
  PerHalfedge<char> out = crease;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (crease[h] || !may_cut(mesh, h) || bend[h] < least_across_frame * angle) continue;
    const Index from = loops.at_corner[h], to = loops.at_corner[next(h)];
    if (from == none || to == none || from == to) continue;
    if (around_nothing[loops.island[h / 3]] >= borders_of_frame) out[h] = out[mesh.twin[h]] = 1;
  }
  return out;
}

// Creases that end inside a patch, whose both sides they are on: where two bores touch, the edge between them fades
// out.
PerHalfedge<char> find_darts(const HalfedgeMesh& mesh, const PerHalfedge<char>& crease) {
  PerTriangle<Index> part;
  label_parts(mesh, crease, part);
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    out[h] = crease[h] && mesh.twin[h] != none && part[h / 3] == part[mesh.twin[h] / 3];
  }
  return out;
}

// The patches of a hard surface, which end in the middle of its bevels, or else at all its creases, including those
// beside narrow strips; none if the surface is not hard.
std::optional<Patches> find_hard_patches(const MetricMesh& surface, const PerHalfedge<char>& crease,
                                         const Eigen::VectorXd& bend, const CreaseOptions& options) {
  const HalfedgeMesh& mesh = surface.mesh;
  std::optional<Patches> out;
  if (std::optional<Bevels> bevels = find_bevels(surface, bend, options.angle)) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const bool is_marked = crease[h] && bend[h] < options.angle;
      bevels->crease[h] = bevels->edge[h] && !is_marked ? bevels->crease[h] && may_cut(mesh, h) : crease[h];
    }
    const PerTriangle<Index> patch = find_patches(surface, bevels->crease, bend, least_patch);
    if (meet_others(mesh, bevels->crease, bend, options.angle)) {
      for (const bool with_darts : {false, true}) {
        const PerHalfedge<char> darts = with_darts ? find_darts(mesh, bevels->crease) : PerHalfedge<char>();
        out.emplace(surface, patch, *bevels, darts);
        if (out->carry_curvature(least_on_bevels, options.most_corners)) return out;
      }
    }
  }
  if (!meet_others(mesh, crease, bend, options.angle)) return std::nullopt;
  const PerHalfedge<char> nowhere(mesh.halfedge_count(), 0);
  const Bevels no_bevels{nowhere, nowhere, PerVertex<char>(mesh.vertex_count(), 0)};
  const PerHalfedge<char> ends = with_frames_divided(surface, crease, bend, options.angle);
  for (const double least_share : {least_patch, 0.0}) {
    out.emplace(surface, find_patches(surface, ends, bend, least_share), no_bevels);
    if (out->carry_curvature(options.least_share, options.most_corners)) return out;
    // Of thousands of small patches, as the teeth of a comb have, the corners are all that is curved.
    if (!out->take_too_many_cones()) break;
  }
  return std::nullopt;
}

}  // namespace

PerHalfedge<char> find_crease_borders(const MetricMesh& surface, const PerHalfedge<char>& crease,
                                      const Eigen::VectorXd& bend, const CreaseOptions& options) {
  const std::optional<Patches> patches = find_hard_patches(surface, crease, bend, options);
  if (!patches) return PerHalfedge<char>(surface.mesh.halfedge_count(), 0);
  PerHalfedge<char> open = patches->unfold_together();
  open_tubes(surface, patches->bevels().edge, open);
  return open;
}

}  // namespace lsgp
