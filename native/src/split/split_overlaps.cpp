// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_overlaps.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/checkpoint.hpp"
#include "split/face_graph.hpp"
#include "split/straight_cuts.hpp"

namespace lsgp {

namespace {

using Link = FaceGraph::Link;
using Units = FaceGraph::Units;

constexpr double operations_an_entry = 500, operations_a_border = 10;

// Of two parts, the lower number first.
using PartPair = std::pair<Index, Index>;
using PartLengths = std::map<PartPair, Units>;

class Splitter {
 public:
  Splitter(const FaceGraph& graph, const Array<Overlap>& overlaps, CutCost rule,
           const std::function<void()>& before_cut);

  void split();
  void merge_back();
  void improve();
  void straighten(const OpenedSurface& surface);

  // (faces)
  const Array<Index>& part() const { return part_; }

 private:
  // Two connected pieces of one part that lie on each other.
  struct Region {
    Array<Index> first, second;  // faces
  };

  // Neighbouring pairs of faces of one part that lie on each other.
  struct Conflict {
    Array<Index> entries;  // the least first
    double area = 0;
    bool is_two_sided = true;  // no face is on both sides
    bool is_larger_than(const Conflict& other) const {
      return area > other.area || (area == other.area && entries.front() < other.entries.front());
    }
  };

  // A part while parts are divided.
  struct Part {
    Array<Index> faces;  // sorted
    Array<Conflict> conflicts;
  };

  void collect_conflicts(const Array<Overlap>& overlaps);
  void number_parts();

  // Both faces are of this part, which a cut can divide only by itself.
  bool is_conflict_in(Index part, Index entry) const {
    return part_[of_[entry]] == part && part_[partner_[entry]] == part;
  }
  Index find_entry(Index face, Index partner) const;
  // Calls visit for the pairs of a part next to one: of the same faces or their neighbours.
  template <typename Visit>
  void for_each_beside(Index part, Index entry, Visit visit) const {
    const auto look_up = [&](Index face, Index partner) {
      if (part_[face] != part || part_[partner] != part) return;
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
  Array<Part> list_parts() const;
  void add_conflicts(const Array<Index>& entries, Array<Part>& parts);
  Conflict find_conflict(Index seed);
  Region find_region(const Array<Part>& parts);
  Region grow_region(const Conflict& conflict);
  void divide(Index part, const Array<char>& is_first, Array<Part>& parts);
  PartLengths measure_borders() const;
  bool improve(Index a, Index b, const Array<Index>& scope, Units length);

  const FaceGraph& graph_;
  MinimumCutter cutter_;
  const std::function<void()>& before_cut_;

  // Faces that lie on each other: (faces + 1), (entries) sorted by face, then partner.
  Array<Index> entry_begin_, of_, partner_;
  Array<double> shared_;  // area

  Array<Index> part_;  // (faces)
  Index part_count_ = 0;

  // Scratch, as it is here between calls.
  Array<char> is_seen_;  // (entries) 0
  Array<Index> depth_;   // (entries) none
  Array<char> side_;     // (faces) 0
};

Splitter::Splitter(const FaceGraph& graph, const Array<Overlap>& overlaps, CutCost rule,
                   const std::function<void()>& before_cut)
    : graph_(graph), cutter_(graph, rule), before_cut_(before_cut), part_(graph.face_count(), 0) {
  collect_conflicts(overlaps);
  number_parts();
  is_seen_.assign(of_.size(), 0);
  depth_.assign(of_.size(), none);
  side_.assign(graph.face_count(), 0);
}

void Splitter::collect_conflicts(const Array<Overlap>& overlaps) {
  Array<Overlap> both;
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
  Array<Index> number(graph_.face_count(), none), front;
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

Array<Splitter::Part> Splitter::list_parts() const {
  Array<Part> parts(part_count_);
  for (Index face = 0; face < graph_.face_count(); ++face) parts[part_[face]].faces.push_back(face);
  return parts;
}

Splitter::Conflict Splitter::find_conflict(Index seed) {
  const Index part = part_[of_[seed]];
  Conflict out{{seed}};
  is_seen_[seed] = 1;
  for (std::size_t i = 0; i < out.entries.size(); ++i) {
    const Index entry = out.entries[i];
    out.area += shared_[entry];
    side_[of_[entry]] = 1;
    for_each_beside(part, entry, [&](Index other) {
      if (is_seen_[other]) return;
      is_seen_[other] = 1;
      out.entries.push_back(other);
    });
  }
  for (const Index entry : out.entries) out.is_two_sided = out.is_two_sided && side_[partner_[entry]] == 0;
  for (const Index entry : out.entries) side_[of_[entry]] = 0;
  checkpoint(operations_an_entry * static_cast<double>(out.entries.size()));
  return out;
}

// Of entries, sorted, that no conflict has.
void Splitter::add_conflicts(const Array<Index>& entries, Array<Part>& parts) {
  for (const Index seed : entries) {
    const Index part = part_[of_[seed]];
    if (!is_seen_[seed] && is_conflict_in(part, seed)) parts[part].conflicts.push_back(find_conflict(seed));
  }
  for (const Index entry : entries) is_seen_[entry] = 0;
}

// The largest conflict of two sides, or where there is none a piece of the largest of all.
Splitter::Region Splitter::find_region(const Array<Part>& parts) {
  const Conflict *two_sided = nullptr, *largest = nullptr;
  for (const Part& part : parts) {
    for (const Conflict& own : part.conflicts) {
      if (largest == nullptr || own.is_larger_than(*largest)) largest = &own;
      if (own.is_two_sided && (two_sided == nullptr || own.is_larger_than(*two_sided))) two_sided = &own;
    }
  }
  if (largest == nullptr) return {};
  if (two_sided == nullptr) return grow_region(*largest);
  Region region;
  for (const Index entry : two_sided->entries) {
    region.first.push_back(of_[entry]);
    region.second.push_back(partner_[entry]);
  }
  return region;
}

// From the pair that shares most, half as far as the two sides stay apart.
Splitter::Region Splitter::grow_region(const Conflict& conflict) {
  const Index seed = *std::max_element(conflict.entries.begin(), conflict.entries.end(),
                                       [&](Index a, Index b) { return shared_[a] < shared_[b]; });
  const Index part = part_[of_[seed]];
  Array<Index> grown{seed};
  depth_[seed] = 0;
  Index deepest = std::numeric_limits<Index>::max();
  for (std::size_t i = 0; i < grown.size() && depth_[grown[i]] < deepest; ++i) {
    const Index entry = grown[i];
    if (side_[of_[entry]] == 2 || side_[partner_[entry]] == 1) {
      deepest = depth_[entry];
      break;
    }
    side_[of_[entry]] = 1;
    side_[partner_[entry]] = 2;
    const auto add = [&](Index other) {
      if (depth_[other] != none) return;
      depth_[other] = depth_[entry] + 1;
      grown.push_back(other);
    };
    for_each_beside(part, entry, add);
  }
  Region region;
  for (const Index entry : grown) {
    if (2 * depth_[entry] <= deepest || entry == seed) {
      region.first.push_back(of_[entry]);
      region.second.push_back(partner_[entry]);
    }
  }
  for (const Index entry : grown) {
    depth_[entry] = none;
    side_[of_[entry]] = side_[partner_[entry]] = 0;
  }
  return region;
}

// Makes parts of the connected faces on either side of a cut; the first of them keeps the number.
void Splitter::divide(Index part, const Array<char>& is_first, Array<Part>& parts) {
  const Array<Index> faces = std::move(parts[part].faces);
  Array<Conflict> conflicts = std::move(parts[part].conflicts);
  constexpr Index first_side = -2, second_side = -3;
  for (std::size_t i = 0; i < faces.size(); ++i) part_[faces[i]] = is_first[i] ? first_side : second_side;
  Array<Index> front, pieces;
  for (const Index seed : faces) {
    const Index side = part_[seed];
    if (side >= 0) continue;
    pieces.push_back(pieces.empty() ? part : part_count_++);
    part_[seed] = pieces.back();
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph_.for_each_link(face, [&](Index other, const Link&) {
        if (part_[other] != side) return;
        part_[other] = pieces.back();
        front.push_back(other);
      });
    }
  }
  parts.resize(part_count_);
  for (const Index piece : pieces) parts[piece] = {};
  for (const Index face : faces) parts[part_[face]].faces.push_back(face);
  for (Conflict& conflict : conflicts) {
    const Index piece = part_[of_[conflict.entries.front()]];
    const bool is_whole = std::all_of(conflict.entries.begin(), conflict.entries.end(),
                                      [&](Index entry) { return is_conflict_in(piece, entry); });
    if (is_whole) {
      parts[piece].conflicts.push_back(std::move(conflict));
    } else {
      std::sort(conflict.entries.begin(), conflict.entries.end());
      add_conflicts(conflict.entries, parts);
    }
  }
}

void Splitter::split() {
  Array<Part> parts = list_parts();
  Array<Index> entries(of_.size());
  std::iota(entries.begin(), entries.end(), 0);
  add_conflicts(entries, parts);
  for (;;) {
    const Region region = find_region(parts);
    if (region.first.empty()) break;
    before_cut_();
    const Index part = part_[region.first.front()];
    divide(part, cutter_.cut(parts[part].faces, region.first, region.second).is_first, parts);
  }
  number_parts();
}

// What was opened between any two parts.
PartLengths Splitter::measure_borders() const {
  PartLengths length;
  for (const Link& link : graph_.links) {
    const auto [a, b] = std::minmax({part_[link.faces[0]], part_[link.faces[1]]});
    if (a != b) length[{a, b}] += link.cost;
  }
  return length;
}

// Closes what was opened between two parts that do not lie on each other, the longest cut first.
void Splitter::merge_back() {
  PartLengths borders = measure_borders();
  Array<std::set<Index>> conflicts(part_count_);  // of every part
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const Index part = part_[of_[i]], other = part_[partner_[i]];
    conflicts[part].insert(other);
    borders.erase(std::minmax({part, other}));
  }
  Array<Index> merged_into(part_count_);
  std::iota(merged_into.begin(), merged_into.end(), 0);
  while (!borders.empty()) {
    checkpoint(operations_a_border * static_cast<double>(borders.size()));
    const auto longest = std::max_element(borders.begin(), borders.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto [kept, merged] = longest->first;
    merged_into[merged] = kept;
    borders.erase(longest);
    for (const Index other : conflicts[merged]) {
      conflicts[other].erase(merged);
      conflicts[other].insert(kept);
      borders.erase(std::minmax({kept, other}));
    }
    conflicts[kept].merge(conflicts[merged]);
    for (auto border = borders.begin(); border != borders.end();) {
      const auto [a, b] = border->first;
      if (a != merged && b != merged) {
        ++border;
        continue;
      }
      const Index other = a == merged ? b : a;
      if (conflicts[kept].count(other) == 0) borders[std::minmax({kept, other})] += border->second;
      border = borders.erase(border);
    }
  }
  // A part is merged into one of a lower number.
  for (Index part = 0; part < part_count_; ++part) merged_into[part] = merged_into[merged_into[part]];
  for (Index& part : part_) part = merged_into[part];
  number_parts();
}

void Splitter::improve() {
  constexpr int most_rounds = 3;
  bool has_changed = true;
  for (int round = 0; has_changed && round < most_rounds; ++round) {
    has_changed = false;
    const Array<Part> parts = list_parts();
    for (const auto& [pair, length] : measure_borders()) {
      const Array<Index>&first = parts[pair.first].faces, &second = parts[pair.second].faces;
      Array<Index> scope;
      std::merge(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(scope));
      has_changed = improve(pair.first, pair.second, scope, length);
      if (has_changed) break;  // parts have other numbers now
    }
  }
}

// Chooses the cut between two neighbours again, all others given. Returns whether there was a better one.
// scope: the faces of both, sorted.
bool Splitter::improve(Index a, Index b, const Array<Index>& scope, Units length) {
  before_cut_();
  Array<Index> first, second;
  double area[2] = {0, 0};
  for (const Index face : scope) {
    area[part_[face] == b] += graph_.area[face];
    const auto lies_on_other = [&](Index partner) { return part_[partner] == a || part_[partner] == b; };
    if (std::any_of(partner_.begin() + entry_begin_[face], partner_.begin() + entry_begin_[face + 1], lies_on_other))
      (part_[face] == a ? first : second).push_back(face);
  }
  const MinimumCut cut = cutter_.cut(scope, first, second);
  constexpr double better = 0.999;
  if (!(cut.cost < better * cutter_.cost(length, std::min(area[0], area[1])))) return false;
  const Array<Index> part_before = part_;
  const Index count_before = part_count_;
  for (std::size_t i = 0; i < scope.size(); ++i) part_[scope[i]] = cut.is_first[i] ? a : b;
  number_parts();
  if (part_count_ <= count_before) return true;
  part_ = part_before;
  part_count_ = count_before;
  return false;
}

void Splitter::straighten(const OpenedSurface& surface) {
  const auto lies_on_other = [&](Index face, Index other) {
    return std::any_of(partner_.begin() + entry_begin_[face], partner_.begin() + entry_begin_[face + 1],
                       [&](Index partner) { return part_[partner] == other; });
  };
  straighten_cuts(surface, graph_, lies_on_other, part_);
}

}  // namespace

Array<Index> split_overlaps(const OpenedSurface& surface, const Array<Overlap>& overlaps, CutCost rule,
                            const std::function<void()>& before_cut) {
  const FaceGraph graph = build_face_graph(surface);
  Splitter splitter(graph, overlaps, rule, before_cut);
  splitter.split();
  splitter.merge_back();
  splitter.improve();
  splitter.straighten(surface);
  Array<Index> opened;
  for (const Link& link : graph.links) {
    if (splitter.part()[link.faces[0]] != splitter.part()[link.faces[1]]) opened.push_back(link.halfedge);
  }
  return opened;
}

}  // namespace lsgp
