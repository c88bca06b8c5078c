// SPDX-License-Identifier: GPL-3.0-or-later
// Divides a layout until no two faces of one part lie on each other.
#pragma once

#include <functional>

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
  void for_each_beside(Index part, Index entry, Visit visit) const {
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
  Array<Part> list_parts() const;
  void add_conflicts(const Array<Index>& entries, Array<Part>& parts);
  Conflict find_conflict(Index seed);
  Region find_region(const Array<Part>& parts);
  Region grow_region(const Conflict& conflict);
  Array<char> cut(const Array<Index>& faces, const Region& region);
  Array<char> cut_nearby(const Array<Index>& faces, const Region& region);
  void divide(Index part, const Array<char>& is_first, Array<Part>& parts);

  const FaceGraph& graph_;
  const OverlapPairs& pairs_;
  MinimumCutter& cutter_;
  const std::function<void()>& before_cut_;
  FaceParts parts_;
  double searched_ = 0;  // faces among which cuts were searched

  // Scratch, as it is here between calls.
  Array<char> is_seen_;  // (entries) 0
  Array<Index> depth_;   // (entries) none
  PerFace<char> side_;   // 0
};

}  // namespace lsgp
