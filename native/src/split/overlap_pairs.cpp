// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/overlap_pairs.hpp"

#include <numeric>

namespace lsgp {

Index OverlapPairs::find(Index face, Index other) const {
  const auto first = partner.begin() + begin[face], end = partner.begin() + begin[face + 1];
  const auto at = std::lower_bound(first, end, other);
  return at != end && *at == other ? static_cast<Index>(at - partner.begin()) : none;
}

OverlapPairs collect_pairs(const FaceGraph& graph, const Array<Overlap>& overlaps) {
  OverlapPairs out;
  Array<Overlap> both;
  for (const Overlap& overlap : overlaps) {
    const Index a = graph.face_of[overlap.first], b = graph.face_of[overlap.second];
    if (a == b) continue;
    both.push_back({a, b, overlap.area});
    both.push_back({b, a, overlap.area});
  }
  std::stable_sort(both.begin(), both.end(), [](const Overlap& a, const Overlap& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  out.begin.assign(graph.face_count() + 1, 0);
  for (std::size_t i = 0; i < both.size(); ++i) {
    if (i > 0 && both[i].first == both[i - 1].first && both[i].second == both[i - 1].second) {
      out.shared.back() += both[i].area;
      continue;
    }
    out.of.push_back(both[i].first);
    out.partner.push_back(both[i].second);
    out.shared.push_back(both[i].area);
    ++out.begin[both[i].first + 1];
  }
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  return out;
}

FaceParts number_parts(const FaceGraph& graph, const PerFace<Index>& number) {
  FaceParts parts{PerFace<Index>(graph.face_count(), none), 0};
  Array<Index> front;
  for (Index seed = 0; seed < graph.face_count(); ++seed) {
    if (parts.of_face[seed] != none) continue;
    parts.of_face[seed] = parts.count;
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph.for_each_link(face, [&](Index other, const FaceGraph::Link&) {
        if (parts.of_face[other] != none || number[other] != number[face]) return;
        parts.of_face[other] = parts.count;
        front.push_back(other);
      });
    }
    ++parts.count;
  }
  return parts;
}

}  // namespace lsgp
