// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "face_graph.hpp"
#include "straight_cuts.hpp"

namespace lsgp {

namespace {

using Link = FaceGraph::Link;
using Units = FaceGraph::Units;

class Splitter {
 public:
  Splitter(const FaceGraph& graph, const std::vector<Overlap>& overlaps, CutTaste taste,
           const std::function<void()>& before_cut);

  void split();
  void merge_back();
  void improve();
  void straighten(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open);

  // (faces)
  const std::vector<Index>& part() const { return part_; }

 private:
  // Two connected parts of the surface that lie on each other.
  struct Region {
    std::vector<Index> first, second;  // faces
  };

  void collect_conflicts(const std::vector<Overlap>& overlaps);
  void number_parts();

  bool is_conflict(Index entry) const { return part_[of_[entry]] == part_[partner_[entry]]; }
  Index find_entry(Index face, Index partner) const;
  // Calls visit for the pairs next to one: of the same faces or their neighbours.
  template <typename Visit>
  void for_each_beside(Index entry, Visit visit) const {
    const auto look_up = [&](Index face, Index partner) {
      const Index found = find_entry(face, partner);
      if (found != none) visit(found);
    };
    const Index own = of_[entry], partner = partner_[entry];
    graph_.for_each_link(partner, [&](Index beside, const Link&) { look_up(own, beside); });
    graph_.for_each_link(own, [&](Index face, const Link&) {
      look_up(face, partner);
      graph_.for_each_link(partner, [&](Index beside, const Link&) { look_up(face, beside); });
    });
  }
  Region find_region() const;
  Region grow_region(const std::vector<Index>& entries) const;
  std::map<std::pair<Index, Index>, Units> measure_borders() const;
  bool improve(Index a, Index b, Units length);

  const FaceGraph& graph_;
  PartCutter cutter_;
  const std::function<void()>& before_cut_;

  // Faces that lie on each other: (faces + 1), (entries) sorted by face, then partner.
  std::vector<Index> entry_begin_, of_, partner_;
  std::vector<double> shared_;  // area

  std::vector<Index> part_;  // (faces)
  Index part_count_ = 0;
};

Splitter::Splitter(const FaceGraph& graph, const std::vector<Overlap>& overlaps, CutTaste taste,
                   const std::function<void()>& before_cut)
    : graph_(graph), cutter_(graph, taste), before_cut_(before_cut), part_(graph.face_count(), 0) {
  collect_conflicts(overlaps);
  number_parts();
}

void Splitter::collect_conflicts(const std::vector<Overlap>& overlaps) {
  std::vector<Overlap> both;
  for (const Overlap& overlap : overlaps) {
    const Index a = graph_.face_of[overlap.first], b = graph_.face_of[overlap.second];
    if (a == b) continue;
    both.push_back({a, b, overlap.area});
    both.push_back({b, a, overlap.area});
  }
  std::stable_sort(both.begin(), both.end(), [](const Overlap& a, const Overlap& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  entry_begin_.assign(graph_.face_count() + 1, 0);
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
}

Index Splitter::find_entry(Index face, Index partner) const {
  const auto begin = partner_.begin() + entry_begin_[face], end = partner_.begin() + entry_begin_[face + 1];
  const auto at = std::lower_bound(begin, end, partner);
  return at != end && *at == partner ? static_cast<Index>(at - partner_.begin()) : none;
}

// Connected faces of one number share a part.
void Splitter::number_parts() {
  std::vector<Index> number(graph_.face_count(), none), front;
  part_count_ = 0;
  for (Index seed = 0; seed < graph_.face_count(); ++seed) {
    if (number[seed] != none) continue;
    number[seed] = part_count_;
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph_.for_each_link(face, [&](Index other, const Link&) {
        if (number[other] != none || part_[other] != part_[face]) return;
        number[other] = part_count_;
        front.push_back(other);
      });
    }
    ++part_count_;
  }
  part_ = std::move(number);
}

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
        if (group[other] != none || !is_conflict(other)) return;
        group[other] = number;
        members.push_back(other);
      };
      for_each_beside(entry, add);
    }
    group_begin.push_back(static_cast<Index>(members.size()));
  }
  std::vector<Index> order(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  // The largest of those whose two sides have no face in common.
  std::vector<Index> marked(graph_.face_count(), none);
  for (const Index g : order) {
    const auto begin = members.begin() + group_begin[g], end = members.begin() + group_begin[g + 1];
    std::for_each(begin, end, [&](Index entry) { marked[of_[entry]] = g; });
    if (std::any_of(begin, end, [&](Index entry) { return marked[partner_[entry]] == g; })) continue;
    Region region;
    std::for_each(begin, end, [&](Index entry) {
      region.first.push_back(of_[entry]);
      region.second.push_back(partner_[entry]);
    });
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
  std::vector<char> side(graph_.face_count(), 0);
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
      if (depth[other] != none || !is_conflict(other)) return;
      depth[other] = depth[entry] + 1;
      grown.push_back(other);
    };
    for_each_beside(entry, add);
  }
  Region region;
  for (const Index entry : grown) {
    if (2 * depth[entry] > deepest && entry != seed) continue;
    region.first.push_back(of_[entry]);
    region.second.push_back(partner_[entry]);
  }
  return region;
}

void Splitter::split() {
  for (;;) {
    const Region region = find_region();
    if (region.first.empty()) return;
    before_cut_();
    std::vector<Index> scope;
    for (Index face = 0; face < graph_.face_count(); ++face) {
      if (part_[face] == part_[region.first.front()]) scope.push_back(face);
    }
    const PartCut cut = cutter_.cut(scope, region.first, region.second);
    for (std::size_t i = 0; i < scope.size(); ++i) {
      if (cut.is_first[i]) part_[scope[i]] = part_count_;
    }
    number_parts();
  }
}

// What was opened between any two parts.
std::map<std::pair<Index, Index>, Units> Splitter::measure_borders() const {
  std::map<std::pair<Index, Index>, Units> length;
  for (const Link& link : graph_.links) {
    const auto [a, b] = std::minmax({part_[link.faces[0]], part_[link.faces[1]]});
    if (a != b) length[{a, b}] += link.cost;
  }
  return length;
}

// Closes what was opened between two parts that do not lie on each other, the longest cut first.
void Splitter::merge_back() {
  for (;;) {
    std::map<std::pair<Index, Index>, Units> borders = measure_borders();
    for (std::size_t i = 0; i < of_.size(); ++i) {
      const auto [a, b] = std::minmax({part_[of_[i]], part_[partner_[i]]});
      borders.erase({a, b});
    }
    if (borders.empty()) return;
    const auto longest = std::max_element(borders.begin(), borders.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto [kept, merged] = longest->first;
    std::replace(part_.begin(), part_.end(), merged, kept);
    number_parts();
  }
}

void Splitter::improve() {
  constexpr int most_rounds = 3;
  bool has_changed = true;
  for (int round = 0; has_changed && round < most_rounds; ++round) {
    has_changed = false;
    for (const auto& [parts, length] : measure_borders()) {
      has_changed = improve(parts.first, parts.second, length);
      if (has_changed) break;  // parts have other numbers now
    }
  }
}

// Chooses the cut between two neighbours again, all others given.  Returns whether there was a better one.
bool Splitter::improve(Index a, Index b, Units length) {
  before_cut_();
  std::vector<Index> scope, first, second;
  double area[2] = {0, 0};
  for (Index face = 0; face < graph_.face_count(); ++face) {
    if (part_[face] != a && part_[face] != b) continue;
    scope.push_back(face);
    area[part_[face] == b] += graph_.area[face];
    const auto lies_on_other = [&](Index partner) { return part_[partner] == a || part_[partner] == b; };
    if (std::any_of(partner_.begin() + entry_begin_[face], partner_.begin() + entry_begin_[face + 1], lies_on_other))
      (part_[face] == a ? first : second).push_back(face);
  }
  const PartCut cut = cutter_.cut(scope, first, second);
  constexpr double better = 0.999;
  if (!(cut.cost < better * cutter_.cost(length, std::min(area[0], area[1])))) return false;
  const std::vector<Index> part_before = part_;
  const Index count_before = part_count_;
  for (std::size_t i = 0; i < scope.size(); ++i) part_[scope[i]] = cut.is_first[i] ? a : b;
  number_parts();
  if (part_count_ <= count_before) return true;
  part_ = part_before;
  part_count_ = count_before;
  return false;
}

void Splitter::straighten(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& open) {
  const auto lies_on_other = [&](Index face, Index other) {
    return std::any_of(partner_.begin() + entry_begin_[face], partner_.begin() + entry_begin_[face + 1],
                       [&](Index partner) { return part_[partner] == other; });
  };
  straighten_cuts(mesh, geometry, graph_, open, lies_on_other, part_);
}

}  // namespace

Index split_overlaps(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Overlap>& overlaps,
                     CutTaste taste, const std::function<void()>& before_cut, std::vector<char>& open) {
  const FaceGraph graph = build_face_graph(mesh, geometry, open);
  Splitter splitter(graph, overlaps, taste, before_cut);
  splitter.split();
  splitter.merge_back();
  splitter.improve();
  splitter.straighten(mesh, geometry, open);
  Index opened = 0;
  for (const Link& link : graph.links) {
    if (splitter.part()[link.faces[0]] == splitter.part()[link.faces[1]]) continue;
    open[link.halfedge] = open[mesh.twin[link.halfedge]] = 1;
    ++opened;
  }
  return opened;
}

}  // namespace lsgp
