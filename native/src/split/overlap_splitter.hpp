// SPDX-License-Identifier: GPL-3.0-or-later
// Divides a layout until no two faces of one part lie on each other.
//
// Cuts separate the largest conflicts of the parts first. Each cut takes time for its whole part and all of its
// conflicts; where this adds up to a multiple of the layout and its pairs, the rest is divided pair by pair, by cuts
// nearby.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "division/minimum_cut.hpp"
#include "split/overlap_pairs.hpp"

namespace lsgp {

class OverlapSplitter {
 public:
  // before_cut: called before every cut; its exceptions propagate.
  OverlapSplitter(Borrowed<const FaceGraph> graph, Borrowed<const OverlapPairs> pairs, MinimumCutter& cutter,
                  Borrowed<const std::function<void()>> before_cut);

  FaceParts split();

 private:
  // Two connected pieces of one part that lie on each other.
  struct Region {
    Array<Index> first, second;  // faces
  };

  // Neighboring pairs of faces of one part that lie on each other.
  struct Conflict {
    Array<Index> entries;  // the least first
    double area = 0;
    bool is_two_sided = true;  // whether no face is on both sides
    bool is_larger_than(const Conflict& other) const {
      return area > other.area || (area == other.area && entries.front() < other.entries.front());
    }
  };

  // A part while parts are divided.
  struct Part {
    Array<Index> faces;  // sorted
    Array<Conflict> conflicts;
  };

  // Whether both faces belong to this part.
  bool is_conflict_in(Index part, Index entry) const {
    return parts_.of_face[pairs_.of[entry]] == part && parts_.of_face[pairs_.partner[entry]] == part;
  }
  // Calls visit for the pairs of a part next to one: of the same faces or their neighbors.
  template <typename Visit>
  void for_each_beside(Index part, Index entry, Visit visit) {
    if (is_beside_many(entry)) return look_through_pairs(part, entry, visit);
    const auto look_up = [&](Index face, Index partner) {
      if (parts_.of_face[face] != part || parts_.of_face[partner] != part) return;
      const Index found = pairs_.find(face, partner);
      if (found != none) visit(found);
    };
    const Index own = pairs_.of[entry], partner = pairs_.partner[entry];
    graph_.for_each_link(partner, [&](Index beside, const FaceGraph::Link&) { look_up(own, beside); });
    graph_.for_each_link(own, [&](Index face, const FaceGraph::Link&) {
      look_up(face, partner);
      graph_.for_each_link(partner, [&](Index beside, const FaceGraph::Link&) { look_up(face, beside); });
    });
  }
  // The same, the pair as well, by going through the pairs of the face with fewer neighbors and of these. What was
  // visited beside the other face already is left out, as it has been seen: polygons with thousands of corners are
  // beside each of their neighbors.
  template <typename Visit>
  void look_through_pairs(Index part, Index entry, Visit visit) {
    const auto [large, small] = by_links(entry);
    const bool is_large_first = large == pairs_.of[entry];
    const auto go_through = [&, large = large](Index face) {
      if (parts_.of_face[face] != part || !looked_through_.emplace(large, is_large_first ? face : ~face).second) return;
      for (Index other = pairs_.begin[face]; other < pairs_.begin[face + 1]; ++other) {
        const Index partner = pairs_.partner[other];
        if (parts_.of_face[partner] != part || (partner != large && !graph_.are_linked(partner, large))) continue;
        visit(is_large_first ? pairs_.find(partner, face) : other);
      }
    };
    go_through(small);
    graph_.for_each_link(small, [&](Index face, const FaceGraph::Link&) { go_through(face); });
  }
  // The faces of a pair, the one with more links first.
  std::pair<Index, Index> by_links(Index entry) const {
    const Index own = pairs_.of[entry], partner = pairs_.partner[entry];
    return graph_.link_count(own) >= graph_.link_count(partner) ? std::pair(own, partner) : std::pair(partner, own);
  }
  // Whether one of a pair's faces has so many neighbors that looking up all pairs of these takes long.
  bool is_beside_many(Index entry) const {
    constexpr std::int64_t few = 1024;
    const std::int64_t own = graph_.link_count(pairs_.of[entry]), partner = graph_.link_count(pairs_.partner[entry]);
    return (own + 1) * (partner + 1) > few;
  }
  Array<Part> list_parts() const;
  void add_conflicts(const Array<Index>& entries, Array<Part>& parts);
  Conflict find_conflict(Index seed);
  Region find_region(const Array<Part>& parts);
  Region grow_region(Index seed);
  void divide(Index part, const Array<char>& is_first, Array<Part>& parts);
  bool has_taken_long() const;
  void split_pair_by_pair();
  Array<Index> first_side_nearby(const Region& region);

  const FaceGraph& graph_;
  const OverlapPairs& pairs_;
  MinimumCutter& cutter_;
  const std::function<void()>& before_cut_;
  FaceParts parts_;
  double searched_ = 0;  // faces among which cuts were searched
  double found_ = 0;     // pairs of the conflicts that were found

  // Scratch, as it is here between calls.
  Array<char> is_seen_;  // (entries) 0
  Array<Index> depth_;   // (entries) none
  PerFace<char> side_;   // 0
  // A face with many neighbors, and a face whose pairs with it and its neighbors were visited, ~face if it is the first
  // of these pairs. Empty.
  std::set<std::pair<Index, Index>> looked_through_;
};

}  // namespace lsgp
