// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/overlap_splitter.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double operations_an_entry = 500;
constexpr double most_found = 16;  // times that pairs are parts of conflicts, on average, before time runs out
// Among which a cut is searched then; a few times those of the regions of such layouts.
constexpr std::size_t faces_nearby = 1024;
constexpr char inside = 1, rim = 2;  // marks of those

}  // namespace

OverlapSplitter::OverlapSplitter(Borrowed<const FaceGraph> graph, Borrowed<const OverlapPairs> pairs,
                                 MinimumCutter& cutter, Borrowed<const std::function<void()>> before_cut)
    : graph_(graph),
      pairs_(pairs),
      cutter_(cutter),
      before_cut_(before_cut),
      parts_(number_parts(graph_, PerFace<Index>(graph_.face_count(), 0))),
      is_seen_(pairs_.of.size(), 0),
      depth_(pairs_.of.size(), none),
      side_(graph_.face_count(), 0) {}

Array<OverlapSplitter::Part> OverlapSplitter::list_parts() const {
  Array<Part> parts(parts_.count);
  for (Index face = 0; face < graph_.face_count(); ++face) parts[parts_.of_face[face]].faces.push_back(face);
  return parts;
}

OverlapSplitter::Conflict OverlapSplitter::find_conflict(Index seed) {
  const Index part = parts_.of_face[pairs_.of[seed]];
  Conflict out{{seed}};
  is_seen_[seed] = 1;
  for (std::size_t i = 0; i < out.entries.size(); ++i) {
    const Index entry = out.entries[i];
    out.area += pairs_.shared[entry];
    side_[pairs_.of[entry]] = 1;
    for_each_beside(part, entry, [&](Index other) {
      if (is_seen_[other]) return;
      is_seen_[other] = 1;
      out.entries.push_back(other);
    });
  }
  looked_through_.clear();
  for (const Index entry : out.entries) out.is_two_sided = out.is_two_sided && side_[pairs_.partner[entry]] == 0;
  for (const Index entry : out.entries) side_[pairs_.of[entry]] = 0;
  found_ += static_cast<double>(out.entries.size());
  checkpoint(operations_an_entry * static_cast<double>(out.entries.size()));
  return out;
}

// Adds the conflicts of those of the sorted entries that no conflict contains yet.
void OverlapSplitter::add_conflicts(const Array<Index>& entries, Array<Part>& parts) {
  for (const Index seed : entries) {
    const Index part = parts_.of_face[pairs_.of[seed]];
    if (!is_seen_[seed] && is_conflict_in(part, seed)) parts[part].conflicts.push_back(find_conflict(seed));
  }
  for (const Index entry : entries) is_seen_[entry] = 0;
}

// The largest conflict between two sides, or if there is none, a piece of the largest of all.
OverlapSplitter::Region OverlapSplitter::find_region(const Array<Part>& parts) {
  const Conflict *two_sided = nullptr, *largest = nullptr;
  for (const Part& part : parts) {
    for (const Conflict& own : part.conflicts) {
      if (largest == nullptr || own.is_larger_than(*largest)) largest = &own;
      if (own.is_two_sided && (two_sided == nullptr || own.is_larger_than(*two_sided))) two_sided = &own;
    }
  }
  if (largest == nullptr) return {};
  if (two_sided == nullptr) {
    return grow_region(*std::max_element(largest->entries.begin(), largest->entries.end(),
                                         [&](Index a, Index b) { return pairs_.shared[a] < pairs_.shared[b]; }));
  }
  Region region;
  for (const Index entry : two_sided->entries) {
    region.first.push_back(pairs_.of[entry]);
    region.second.push_back(pairs_.partner[entry]);
  }
  return region;
}

// Grows from a pair to half the distance at which the two sides would meet.
OverlapSplitter::Region OverlapSplitter::grow_region(Index seed) {
  const Index part = parts_.of_face[pairs_.of[seed]];
  Array<Index> grown{seed};
  depth_[seed] = 0;
  Index deepest = std::numeric_limits<Index>::max();
  for (std::size_t i = 0; i < grown.size() && depth_[grown[i]] < deepest; ++i) {
    const Index entry = grown[i];
    if (side_[pairs_.of[entry]] == 2 || side_[pairs_.partner[entry]] == 1) {
      deepest = depth_[entry];
      break;
    }
    side_[pairs_.of[entry]] = 1;
    side_[pairs_.partner[entry]] = 2;
    const auto add = [&](Index other) {
      if (depth_[other] != none) return;
      depth_[other] = depth_[entry] + 1;
      grown.push_back(other);
    };
    for_each_beside(part, entry, add);
  }
  looked_through_.clear();
  Region region;
  for (const Index entry : grown) {
    if (2 * depth_[entry] <= deepest || entry == seed) {
      region.first.push_back(pairs_.of[entry]);
      region.second.push_back(pairs_.partner[entry]);
    }
  }
  for (const Index entry : grown) {
    depth_[entry] = none;
    side_[pairs_.of[entry]] = side_[pairs_.partner[entry]] = 0;
  }
  return region;
}

// Turns the connected faces on either side of a cut into parts; the first of them keeps the number.
void OverlapSplitter::divide(Index part, const Array<char>& is_first, Array<Part>& parts) {
  const Array<Index> faces = std::move(parts[part].faces);
  Array<Conflict> conflicts = std::move(parts[part].conflicts);
  constexpr Index first_side = -2, second_side = -3;
  for (std::size_t i = 0; i < faces.size(); ++i) parts_.of_face[faces[i]] = is_first[i] ? first_side : second_side;
  Array<Index> front, pieces;
  for (const Index seed : faces) {
    const Index side = parts_.of_face[seed];
    if (side >= 0) continue;
    pieces.push_back(pieces.empty() ? part : parts_.count++);
    parts_.of_face[seed] = pieces.back();
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph_.for_each_link(face, [&](Index other, const FaceGraph::Link&) {
        if (parts_.of_face[other] != side) return;
        parts_.of_face[other] = pieces.back();
        front.push_back(other);
      });
    }
  }
  parts.resize(parts_.count);
  for (const Index piece : pieces) parts[piece] = {};
  for (const Index face : faces) parts[parts_.of_face[face]].faces.push_back(face);
  for (Conflict& conflict : conflicts) {
    const Index piece = parts_.of_face[pairs_.of[conflict.entries.front()]];
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

bool OverlapSplitter::has_taken_long() const {
  return searched_ > most_searches * graph_.face_count() || found_ > most_found * static_cast<double>(pairs_.of.size());
}

// Which faces of a part are on the first side of the best cut between the two sides of a region, among those nearest to
// the first side, whose outermost ones stay on the second side.
Array<Index> OverlapSplitter::first_side_nearby(const Region& region) {
  const Index part = parts_.of_face[region.first.front()];
  Array<Index> scope = region.first, second;
  sort_unique(scope);
  for (const Index face : scope) side_[face] = inside;
  std::size_t ring = 0;
  while (ring < scope.size() && (ring == 0 || scope.size() < faces_nearby)) {
    const std::size_t end = scope.size();
    for (; ring < end; ++ring) {
      graph_.for_each_link(scope[ring], [&](Index other, const FaceGraph::Link&) {
        if (parts_.of_face[other] != part || side_[other] != 0) return;
        side_[other] = inside;
        scope.push_back(other);
      });
    }
  }
  for (std::size_t i = ring; i < scope.size(); ++i) side_[scope[i]] = rim;
  for (const Index face : region.second) {
    if (side_[face] != 0) side_[face] = rim;
  }
  std::copy_if(scope.begin(), scope.end(), std::back_inserter(second), [&](Index face) { return side_[face] == rim; });
  for (const Index face : scope) side_[face] = 0;
  std::sort(scope.begin(), scope.end());
  const MinimumCut cut = cutter_.cut(scope, region.first, second);
  Array<Index> out;
  for (std::size_t i = 0; i < scope.size(); ++i) {
    if (cut.is_first[i]) out.push_back(scope[i]);
  }
  return out;
}

// Parts need not be connected then.
void OverlapSplitter::split_pair_by_pair() {
  Array<Index> entries;
  for (Index entry = 0; entry < static_cast<Index>(pairs_.of.size()); ++entry) {
    if (is_conflict_in(parts_.of_face[pairs_.of[entry]], entry)) entries.push_back(entry);
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [&](Index a, Index b) { return pairs_.shared[a] > pairs_.shared[b]; });
  for (const Index entry : entries) {
    if (!is_conflict_in(parts_.of_face[pairs_.of[entry]], entry)) continue;
    before_cut_();
    for (const Index face : first_side_nearby(grow_region(entry))) parts_.of_face[face] = parts_.count;
    ++parts_.count;
  }
}

FaceParts OverlapSplitter::split() {
  Array<Part> parts = list_parts();
  Array<Index> entries(pairs_.of.size());
  std::iota(entries.begin(), entries.end(), 0);
  add_conflicts(entries, parts);
  found_ = 0;
  while (!has_taken_long()) {
    const Region region = find_region(parts);
    if (region.first.empty()) break;
    before_cut_();
    const Index part = parts_.of_face[region.first.front()];
    const Array<Index>& faces = parts[part].faces;
    searched_ += static_cast<double>(faces.size());
    divide(part, cutter_.cut(faces, region.first, region.second).is_first, parts);
  }
  split_pair_by_pair();
  return number_parts(graph_, parts_.of_face);
}

}  // namespace lsgp
