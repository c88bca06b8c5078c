// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer and shorter cuts between the overlapping parts of a layout.
#pragma once

#include <functional>
#include <map>
#include <utility>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "division/minimum_cut.hpp"
#include "split/overlap_pairs.hpp"

namespace lsgp {

class PartMerger {
 public:
  // parts: no two faces of a part overlap, which is preserved.  before_cut: called before every cut; its exceptions
  // propagate.
  PartMerger(Borrowed<const FaceGraph> graph, Borrowed<const OverlapPairs> pairs, MinimumCutter& cutter,
             Borrowed<const std::function<void()>> before_cut, FaceParts& parts)
      : graph_(graph), pairs_(pairs), cutter_(cutter), before_cut_(before_cut), parts_(parts) {}

  // Closes cuts between two parts that do not overlap, the longest first.
  void merge_back();

  // Chooses the cuts between neighbors again, as long as that takes no more than `most_searches`.
  void improve();

  // See straight_cuts.hpp.
  void straighten(const OpenedSurface& surface);

 private:
  // By two parts, the lower number first.
  using PartLengths = std::map<std::pair<Index, Index>, FaceGraph::Units>;

  PartLengths measure_borders() const;           // of what was opened between any two parts
  PerPart<Array<Index>> faces_of_parts() const;  // sorted
  // Optimizes the cut between two neighbors, all others fixed. Returns whether there was a better one.
  // scope: the faces of both, sorted.
  bool improve(Index a, Index b, const Array<Index>& scope, FaceGraph::Units length);

  const FaceGraph& graph_;
  const OverlapPairs& pairs_;
  MinimumCutter& cutter_;
  const std::function<void()>& before_cut_;
  FaceParts& parts_;
  double searched_ = 0;  // faces among which cuts were searched
};

}  // namespace lsgp
