// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_overlaps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "solvers/max_flow.hpp"

namespace lsgp {

namespace {

using Units = FlowNetwork::Units;

constexpr double seam_discount = 0.2, sharp_discount = 0.5;  // of a cut's length along marked seams and sharp edges
const double sharp_angle = M_PI / 6;
constexpr double units_of_mean_edge = 1e4;
constexpr double enough_area = 0.02;  // of the surface: a part so large need not be larger

double discount(const HalfedgeMesh& mesh, Index h) {
  if (mesh.seam[h]) return seam_discount;
  const auto normal = [&](Index f) {
    const Eigen::Vector3d a = mesh.positions.row(mesh.triangles(f, 0)), b = mesh.positions.row(mesh.triangles(f, 1)),
                          c = mesh.positions.row(mesh.triangles(f, 2));
    return Eigen::Vector3d((b - a).cross(c - a));
  };
  const Eigen::Vector3d here = normal(h / 3), there = normal(mesh.twin[h] / 3);
  return std::atan2(here.cross(there).norm(), here.dot(there)) > sharp_angle ? sharp_discount : 1.0;
}

class Splitter {
 public:
  Splitter(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Overlap>& overlaps,
           const std::vector<char>& open);

  void split();
  void merge_back();
  void improve();

  // (triangles)
  Index part(Index triangle) const { return part_[face_[triangle]]; }

 private:
  // Across an edge that may be opened.
  struct Link {
    Index faces[2];
    Units cost;
  };
  // Two connected parts of the surface that lie on each other.
  struct Region {
    std::vector<Index> first, second;  // faces
    double area = 0;
    bool is_mixed = false;  // they have faces in common
  };
  struct Choice {
    std::vector<char> is_first;  // by place in the scope
    double cost = std::numeric_limits<double>::infinity();
  };

  void collect_faces(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open);
  void collect_conflicts(const std::vector<Overlap>& overlaps);
  void number_parts();

  bool is_conflict(Index entry) const { return part_[of_[entry]] == part_[partner_[entry]]; }
  Index find_entry(Index face, Index partner) const;
  Region find_region() const;
  Region grow_region(const std::vector<Index>& entries) const;

  // The cheapest cut that parts `first` from `second` within the scope, a set of faces.
  Choice choose_cut(const std::vector<Index>& scope, const std::vector<Index>& first, const std::vector<Index>& second);
  double cost(Units units, double smaller_area) const {
    return static_cast<double>(units) / std::sqrt(std::min(smaller_area, enough_));
  }
  std::array<std::vector<Index>, 2> divide(const std::vector<Index>& scope, const std::vector<Index>& first,
                                           const std::vector<Index>& second) const;

  template <typename Visit>
  void for_each_link(Index face, Visit visit) const {
    for (Index i = link_begin_[face]; i < link_begin_[face + 1]; ++i) {
      const Link& link = links_[link_[i]];
      visit(link.faces[link.faces[0] == face], link);
    }
  }

  Index face_count_ = 0;
  std::vector<Index> face_;   // (triangles) triangles that no cut may part are one face
  std::vector<double> area_;  // (faces)
  std::vector<Link> links_;
  std::vector<Index> link_begin_, link_;  // of every face

  // Faces that lie on each other: (faces + 1), (entries) sorted by face, then partner.
  std::vector<Index> entry_begin_, of_, partner_, reverse_;
  std::vector<double> shared_;  // area

  std::vector<Index> part_;  // (faces)
  Index part_count_ = 0;
  double enough_ = 0;
  std::vector<Index> place_;  // (faces) in a scope, none elsewhere
};

Splitter::Splitter(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Overlap>& overlaps,
                   const std::vector<char>& open) {
  collect_faces(mesh, geometry, open);
  collect_conflicts(overlaps);
  part_.assign(face_count_, 0);
  place_.assign(face_count_, none);
  number_parts();
}

void Splitter::collect_faces(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open) {
  std::vector<char> is_side(mesh.halfedge_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) is_side[h] = open[h] || mesh.cuttable[h];
  face_count_ = label_parts(mesh, is_side, face_);
  area_.assign(face_count_, 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area_[face_[f]] += geometry.area[f];
  enough_ = enough_area * geometry.total_area;
  const double unit = geometry.length.mean() / units_of_mean_edge;
  link_begin_.assign(face_count_ + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin < h || open[h] || face_[h / 3] == face_[twin / 3]) continue;
    const double units = geometry.length[h] * discount(mesh, h) / unit;
    links_.push_back({{face_[h / 3], face_[twin / 3]}, std::max<Units>(1, std::llround(units))});
    for (const Index face : links_.back().faces) ++link_begin_[face + 1];
  }
  std::partial_sum(link_begin_.begin(), link_begin_.end(), link_begin_.begin());
  link_.resize(2 * links_.size());
  std::vector<Index> cursor(link_begin_.begin(), link_begin_.end() - 1);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    for (const Index face : links_[i].faces) link_[cursor[face]++] = static_cast<Index>(i);
  }
}

void Splitter::collect_conflicts(const std::vector<Overlap>& overlaps) {
  std::vector<Overlap> both;
  for (const Overlap& overlap : overlaps) {
    const Index a = face_[overlap.first], b = face_[overlap.second];
    if (a == b) continue;
    both.push_back({a, b, overlap.area});
    both.push_back({b, a, overlap.area});
  }
  std::stable_sort(both.begin(), both.end(), [](const Overlap& a, const Overlap& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  entry_begin_.assign(face_count_ + 1, 0);
  for (std::size_t i = 0; i < both.size(); ++i) {
    if (i > 0 && both[i].first == both[i - 1].first && both[i].second == both[i - 1].second) {
      shared_.back() += both[i].area;
      continue;
    }
    of_.push_back(both[i].first);
    partner_.push_back(both[i].second);
    shared_.push_back(both[i].area);
    ++entry_begin_[both[i].first + 1];
  }
  std::partial_sum(entry_begin_.begin(), entry_begin_.end(), entry_begin_.begin());
  for (std::size_t i = 0; i < of_.size(); ++i) reverse_.push_back(find_entry(partner_[i], of_[i]));
}

Index Splitter::find_entry(Index face, Index partner) const {
  const auto begin = partner_.begin() + entry_begin_[face], end = partner_.begin() + entry_begin_[face + 1];
  const auto at = std::lower_bound(begin, end, partner);
  return at != end && *at == partner ? static_cast<Index>(at - partner_.begin()) : none;
}

// Connected faces of one number share a part.
void Splitter::number_parts() {
  std::vector<Index> number(face_count_, none), front;
  part_count_ = 0;
  for (Index seed = 0; seed < face_count_; ++seed) {
    if (number[seed] != none) continue;
    number[seed] = part_count_;
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      for_each_link(face, [&](Index other, const Link&) {
        if (number[other] != none || part_[other] != part_[face]) return;
        number[other] = part_count_;
        front.push_back(other);
      });
    }
    ++part_count_;
  }
  part_ = std::move(number);
}

// Pairs belong together when they have one face in common and the others are neighbours.
Splitter::Region Splitter::find_region() const {
  const Index entry_count = static_cast<Index>(of_.size());
  std::vector<Index> group(entry_count, none);
  std::vector<Index> members, group_begin{0};
  std::vector<double> area;
  for (Index seed = 0; seed < entry_count; ++seed) {
    if (group[seed] != none || !is_conflict(seed)) continue;
    const Index number = static_cast<Index>(area.size());
    area.push_back(0);
    group[seed] = number;
    members.push_back(seed);
    for (std::size_t i = group_begin.back(); i < members.size(); ++i) {
      const Index entry = members[i];
      area.back() += shared_[entry];
      const auto add = [&](Index other) {
        if (other == none || group[other] != none || !is_conflict(other)) return;
        group[other] = number;
        members.push_back(other);
      };
      for_each_link(of_[entry], [&](Index face, const Link&) { add(find_entry(face, partner_[entry])); });
      for_each_link(partner_[entry], [&](Index face, const Link&) { add(find_entry(of_[entry], face)); });
    }
    group_begin.push_back(static_cast<Index>(members.size()));
  }
  std::vector<Index> order(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  std::vector<Index> marked(face_count_, none);
  for (const Index g : order) {
    Region region;
    for (Index i = group_begin[g]; i < group_begin[g + 1]; ++i) marked[of_[members[i]]] = g;
    for (Index i = group_begin[g]; i < group_begin[g + 1]; ++i) {
      region.is_mixed = region.is_mixed || marked[partner_[members[i]]] == g;
    }
    if (region.is_mixed) continue;
    region.area = area[g];
    for (Index i = group_begin[g]; i < group_begin[g + 1]; ++i) {
      region.first.push_back(of_[members[i]]);
      region.second.push_back(partner_[members[i]]);
    }
    return region;
  }
  if (order.empty()) return {};
  return grow_region({members.begin() + group_begin[order[0]], members.begin() + group_begin[order[0] + 1]});
}

// From the pair that shares most, half as far as the two sides stay apart.
Splitter::Region Splitter::grow_region(const std::vector<Index>& entries) const {
  const Index seed =
      *std::max_element(entries.begin(), entries.end(), [&](Index a, Index b) { return shared_[a] < shared_[b]; });
  std::vector<Index> depth(of_.size(), none), grown{seed};
  std::vector<char> side(face_count_, 0);
  depth[seed] = 0;
  Index deepest = std::numeric_limits<Index>::max();
  for (std::size_t i = 0; i < grown.size() && depth[grown[i]] < deepest; ++i) {
    const Index entry = grown[i];
    if (side[of_[entry]] == 2 || side[partner_[entry]] == 1) {
      deepest = depth[entry];
      break;
    }
    side[of_[entry]] = 1;
    side[partner_[entry]] = 2;
    const auto add = [&](Index other) {
      if (other == none || depth[other] != none || !is_conflict(other)) return;
      depth[other] = depth[entry] + 1;
      grown.push_back(other);
    };
    for_each_link(of_[entry], [&](Index face, const Link&) { add(find_entry(face, partner_[entry])); });
    for_each_link(partner_[entry], [&](Index face, const Link&) { add(find_entry(of_[entry], face)); });
  }
  Region region;
  for (const Index entry : grown) {
    if (2 * depth[entry] > deepest && entry != seed) continue;
    region.first.push_back(of_[entry]);
    region.second.push_back(partner_[entry]);
  }
  return region;
}

// The faces of a scope that are nearer to one set than to another, the nearest first: those of either set.
std::array<std::vector<Index>, 2> Splitter::divide(const std::vector<Index>& scope, const std::vector<Index>& first,
                                                   const std::vector<Index>& second) const {
  struct Entry {
    double distance;
    Index face;
    char side;
    bool operator>(const Entry& other) const {
      return distance != other.distance ? distance > other.distance : face > other.face;
    }
  };
  std::vector<double> distance(scope.size(), std::numeric_limits<double>::infinity());
  std::vector<char> is_done(scope.size(), 0);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](Index face, double through, char side) {
    if (place_[face] == none || through >= distance[place_[face]]) return;
    distance[place_[face]] = through;
    queue.push({through, face, side});
  };
  for (const Index face : first) reach(face, 0, 0);
  for (const Index face : second) reach(face, 0, 1);
  std::array<std::vector<Index>, 2> out;
  while (!queue.empty()) {
    const Entry nearest = queue.top();
    queue.pop();
    char& done = is_done[place_[nearest.face]];
    if (done) continue;
    done = 1;
    out[nearest.side].push_back(nearest.face);
    for_each_link(nearest.face, [&](Index other, const Link&) {
      reach(other, nearest.distance + std::sqrt(area_[nearest.face]) + std::sqrt(area_[other]), nearest.side);
    });
  }
  return out;
}

Splitter::Choice Splitter::choose_cut(const std::vector<Index>& scope, const std::vector<Index>& first,
                                      const std::vector<Index>& second) {
  const Index count = static_cast<Index>(scope.size()), source = count, sink = count + 1;
  for (Index i = 0; i < count; ++i) place_[scope[i]] = i;
  double scope_area = 0;
  Units all = 1;
  FlowNetwork network(count + 2);
  for (const Index face : scope) {
    scope_area += area_[face];
    for_each_link(face, [&](Index other, const Link& link) {
      if (place_[other] == none || link.faces[0] != face) return;
      network.add_arc(place_[face], place_[other], link.cost, link.cost);
      all += link.cost;
    });
  }
  for (const Index face : first) network.add_arc(source, place_[face], all);
  for (const Index face : second) network.add_arc(place_[face], sink, all);
  const Units least = network.maximize(source, sink);
  Choice best;
  const auto judge = [&](const FlowNetwork& maximal, Units flow) {
    Choice choice;
    choice.is_first = maximal.reachable(source);
    choice.is_first.resize(count);
    double area = 0;
    for (Index i = 0; i < count; ++i) area += choice.is_first[i] ? area_[scope[i]] : 0;
    choice.cost = cost(flow, std::min(area, scope_area - area));
    if (flow < all && choice.cost < best.cost) best = std::move(choice);
    return std::array<double, 2>{area, scope_area - area};
  };
  const std::array<double, 2> least_areas = judge(network, least);
  // Cuts further away from what they part, on one side or on both, which leave larger parts.
  const std::array<std::vector<Index>, 2> nearest = divide(scope, first, second);
  for (const std::array<bool, 2> grows : {std::array{true, false}, std::array{false, true}, std::array{true, true}}) {
    FlowNetwork grown = network;
    Units flow = least;
    std::array<double, 2> areas = least_areas, taken{0, 0};
    std::array<std::size_t, 2> next{0, 0};
    for (;;) {
      bool has_grown = false;
      for (const int side : {0, 1}) {
        const double target = std::min(2 * areas[side], enough_);
        if (!grows[side] || areas[side] >= enough_) continue;
        for (; next[side] < nearest[side].size() && taken[side] < target; ++next[side]) {
          const Index face = nearest[side][next[side]];
          taken[side] += area_[face];
          side == 0 ? grown.add_arc(source, place_[face], all) : grown.add_arc(place_[face], sink, all);
          has_grown = true;
        }
      }
      if (!has_grown || cost(flow, enough_) >= best.cost) break;
      flow += grown.maximize(source, sink);
      areas = judge(grown, flow);
    }
  }
  for (const Index face : scope) place_[face] = none;
  return best;
}

void Splitter::split() {
  for (;;) {
    const Region region = find_region();
    if (region.first.empty()) return;
    std::vector<Index> scope;
    for (Index face = 0; face < face_count_; ++face) {
      if (part_[face] == part_[region.first.front()]) scope.push_back(face);
    }
    const Choice choice = choose_cut(scope, region.first, region.second);
    for (std::size_t i = 0; i < scope.size(); ++i) {
      if (choice.is_first[i]) part_[scope[i]] = part_count_;
    }
    number_parts();
  }
}

// Closes what was opened between two parts that do not lie on each other, the longest cut first.
void Splitter::merge_back() {
  for (;;) {
    std::map<std::pair<Index, Index>, Units> shared;
    for (const Link& link : links_) {
      const auto [a, b] = std::minmax({part_[link.faces[0]], part_[link.faces[1]]});
      if (a != b) shared[{a, b}] += link.cost;
    }
    for (std::size_t i = 0; i < of_.size(); ++i) {
      const auto [a, b] = std::minmax({part_[of_[i]], part_[partner_[i]]});
      shared.erase({a, b});
    }
    if (shared.empty()) return;
    const auto longest = std::max_element(shared.begin(), shared.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto [kept, merged] = longest->first;
    for (Index& part : part_) {
      if (part == merged) part = kept;
    }
    number_parts();
  }
}

// Chooses the cut between two neighbouring parts again, given all others.
void Splitter::improve() {
  constexpr int rounds = 3;
  bool changed = true;
  for (int round = 0; changed && round < rounds; ++round) {
    changed = false;
    std::map<std::pair<Index, Index>, Units> neighbours;
    for (const Link& link : links_) {
      const auto [a, b] = std::minmax({part_[link.faces[0]], part_[link.faces[1]]});
      if (a != b) neighbours[{a, b}] += link.cost;
    }
    for (const auto& [pair, unused] : neighbours) {
      const auto [a, b] = pair;
      std::vector<Index> scope, first, second;
      double area[2] = {0, 0};
      Units length = 0;
      for (Index face = 0; face < face_count_; ++face) {
        if (part_[face] != a && part_[face] != b) continue;
        scope.push_back(face);
        area[part_[face] == b] += area_[face];
        bool is_fixed = false;
        for (Index i = entry_begin_[face]; i < entry_begin_[face + 1]; ++i) {
          is_fixed = is_fixed || part_[partner_[i]] == a || part_[partner_[i]] == b;
        }
        if (is_fixed) (part_[face] == a ? first : second).push_back(face);
        if (part_[face] != a) continue;
        for_each_link(face, [&](Index other, const Link& link) { length += part_[other] == b ? link.cost : 0; });
      }
      const Choice choice = choose_cut(scope, first, second);
      if (!(choice.cost < 0.999 * cost(length, std::min(area[0], area[1])))) continue;
      const std::vector<Index> before = part_;
      const Index count_before = part_count_;
      for (std::size_t i = 0; i < scope.size(); ++i) part_[scope[i]] = choice.is_first[i] ? a : b;
      number_parts();
      if (part_count_ > count_before) {
        part_ = before;
        part_count_ = count_before;
        continue;
      }
      changed = true;
      break;  // numbers have changed
    }
  }
}

}  // namespace

Index split_overlaps(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Overlap>& overlaps,
                     std::vector<char>& open) {
  Splitter splitter(mesh, geometry, overlaps, open);
  splitter.split();
  splitter.merge_back();
  splitter.improve();
  Index opened = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin < h || open[h] || splitter.part(h / 3) == splitter.part(twin / 3)) continue;
    open[h] = open[twin] = 1;
    ++opened;
  }
  return opened;
}

}  // namespace lsgp
