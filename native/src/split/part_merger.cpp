// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/part_merger.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <set>

#include "base/checkpoint.hpp"
#include "division/straight_cuts.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_merge = 10;

}  // namespace

PartMerger::PartLengths PartMerger::measure_borders() const {
  PartLengths length;
  for (const FaceGraph::Link& link : graph_.links) {
    const auto [a, b] = std::minmax({parts_.of_face[link.faces[0]], parts_.of_face[link.faces[1]]});
    if (a != b) length[{a, b}] += link.cost;
  }
  return length;
}

void PartMerger::merge_back() {
  PartLengths borders = measure_borders();
  PerPart<std::set<Index>> conflicts(parts_.count);
  for (std::size_t i = 0; i < pairs_.of.size(); ++i) {
    const Index part = parts_.of_face[pairs_.of[i]], other = parts_.of_face[pairs_.partner[i]];
    conflicts[part].insert(other);
    borders.erase(std::minmax({part, other}));
  }
  PerPart<Index> merged_into(parts_.count);
  std::iota(merged_into.begin(), merged_into.end(), 0);
  while (!borders.empty()) {
    checkpoint(operations_a_merge * static_cast<double>(borders.size()));
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
  for (Index part = 0; part < parts_.count; ++part) merged_into[part] = merged_into[merged_into[part]];
  for (Index& part : parts_.of_face) part = merged_into[part];
  parts_ = number_parts(graph_, parts_.of_face);
}

PerPart<Array<Index>> PartMerger::faces_of_parts() const {
  PerPart<Array<Index>> faces(parts_.count);
  for (Index face = 0; face < graph_.face_count(); ++face) faces[parts_.of_face[face]].push_back(face);
  return faces;
}

void PartMerger::improve() {
  constexpr int most_rounds = 3;
  bool has_changed = true;
  // Pairs of parts without a better cut between them. Numbers of parts change: one is known by its first face and the
  // round that made it.
  std::set<std::array<Index, 4>> tried;
  PerFace<Index> made(graph_.face_count(), 0);
  for (int round = 0; has_changed && round < most_rounds; ++round) {
    has_changed = false;
    const PerPart<Array<Index>> faces = faces_of_parts();
    for (const auto& [pair, length] : measure_borders()) {
      const Array<Index>&first = faces[pair.first], &second = faces[pair.second];
      const Index a = first.front(), b = second.front();
      if (!tried.insert({a, made[a], b, made[b]}).second) continue;
      searched_ += static_cast<double>(first.size() + second.size());
      if (searched_ > most_searches * graph_.face_count()) return;
      Array<Index> scope;
      std::merge(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(scope));
      has_changed = improve(pair.first, pair.second, scope, length);
      if (!has_changed) continue;
      for (const Index face : scope) made[face] = round + 1;
      break;  // parts have other numbers now
    }
  }
}

bool PartMerger::improve(Index a, Index b, const Array<Index>& scope, FaceGraph::Units length) {
  before_cut_();
  Array<Index> first, second;
  double area[2] = {0, 0};
  for (const Index face : scope) {
    area[parts_.of_face[face] == b] += graph_.area[face];
    const auto lies_on_other = [&](Index partner) {
      return parts_.of_face[partner] == a || parts_.of_face[partner] == b;
    };
    if (pairs_.any_partner(face, lies_on_other)) (parts_.of_face[face] == a ? first : second).push_back(face);
  }
  constexpr double better = 0.999;
  const double cost_to_beat = better * cutter_.cost(length, std::min(area[0], area[1]));
  const MinimumCut cut = cutter_.cut(scope, first, second, cost_to_beat);
  if (!(cut.cost < cost_to_beat)) return false;
  const FaceParts before = parts_;
  for (std::size_t i = 0; i < scope.size(); ++i) parts_.of_face[scope[i]] = cut.is_first[i] ? a : b;
  parts_ = number_parts(graph_, parts_.of_face);
  if (parts_.count <= before.count) return true;
  parts_ = before;
  return false;
}

void PartMerger::straighten(const OpenedSurface& surface) {
  const auto lies_on_other = [&](Index face, Index other) {
    return pairs_.any_partner(face, [&](Index partner) { return parts_.of_face[partner] == other; });
  };
  straighten_cuts(surface, graph_, lies_on_other, parts_.of_face);
}

}  // namespace lsgp
