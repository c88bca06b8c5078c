// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/own_overlaps.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "division/minimum_cut.hpp"
#include "split/overlap_pairs.hpp"

namespace lsgp {

namespace {

constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

// The layout of a map.
struct MapLayout {
  Eigen::VectorXcd corners;  // NaN of flipped triangles
  PerHalfedge<Index> twin;   // none where the map ends
};

MapLayout layout_of(const HalfedgeMesh& mesh, const ComponentMap& map) {
  MapLayout out{at_corners(map.cut_mesh, map.position), mesh.twin};
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (map.cut_graph.is_cut[h]) out.twin[h] = none;
  }
  for (const Index f : map.validity.flipped) {
    out.corners.segment<3>(3 * f).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

// Halves a crowded map until no piece of it is.
class PieceHalver {
 public:
  PieceHalver(const OpenedSurface& surface, const MapLayout& layout)
      : layout_(layout),
        graph_(build_face_graph(surface)),
        triangles_(graph_.face_count()),
        place_(surface.mesh.triangle_count(), none),
        is_waiting_(graph_.face_count(), 0),
        cutter_(graph_, CutCost::shortest) {
    for (Index f = 0; f < surface.mesh.triangle_count(); ++f) triangles_[graph_.face_of[f]].push_back(f);
  }

  OwnOverlaps halve() {
    OwnOverlaps out;
    FaceParts parts = number_parts(graph_, PerFace<Index>(graph_.face_count(), 0));
    Array<Array<Index>> waiting(parts.count);
    for (Index face = 0; face < graph_.face_count(); ++face) waiting[parts.of_face[face]].push_back(face);
    while (!waiting.empty()) {
      const Array<Index> piece = std::move(waiting.back());
      waiting.pop_back();
      if (const auto pairs = pairs_within(piece)) {
        out.pairs.insert(out.pairs.end(), pairs->begin(), pairs->end());
        continue;
      }
      const Array<char> is_first = halves(piece);
      Array<Index> first, second;
      for (std::size_t i = 0; i < piece.size(); ++i) (is_first[i] ? first : second).push_back(piece[i]);
      for (const Index face : second) parts.of_face[face] = parts.count;
      ++parts.count;
      waiting.push_back(std::move(first));
      waiting.push_back(std::move(second));
    }
    std::sort(out.pairs.begin(), out.pairs.end(), [](const Overlap& a, const Overlap& b) {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    for (const FaceGraph::Link& link : graph_.links) {
      if (parts.of_face[link.faces[0]] != parts.of_face[link.faces[1]]) out.ends.push_back(link.halfedge);
    }
    return out;
  }

 private:
  // Of some faces; none if these are crowded.
  std::optional<Array<Overlap>> pairs_within(const Array<Index>& piece) {
    Array<Index> own;
    for (const Index face : piece) own.insert(own.end(), triangles_[face].begin(), triangles_[face].end());
    std::sort(own.begin(), own.end());
    for (std::size_t i = 0; i < own.size(); ++i) place_[own[i]] = static_cast<Index>(i);
    MapLayout part{Eigen::VectorXcd(3 * ssize(own)), PerHalfedge<Index>(3 * own.size(), none)};
    for (Index h = 0; h < static_cast<Index>(part.twin.size()); ++h) {
      const Index of_map = 3 * own[h / 3] + h % 3, beyond = layout_.twin[of_map];
      part.corners[h] = layout_.corners[of_map];
      if (beyond != none && place_[beyond / 3] != none) part.twin[h] = 3 * place_[beyond / 3] + beyond % 3;
    }
    for (const Index f : own) place_[f] = none;
    PerTriangle<Index> face(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) face[i] = graph_.face_of[own[i]];
    // Most of a piece may be one face.
    const std::size_t largest = triangles_[*std::max_element(piece.begin(), piece.end(), [&](Index a, Index b) {
                                  return triangles_[a].size() < triangles_[b].size();
                                })].size();
    const std::size_t most = 2 * largest > own.size() ? any_number : crowded * own.size();
    std::optional<Array<Overlap>> pairs = find_few_overlaps(part.corners, part.twin, most, face);
    if (!pairs) return std::nullopt;
    for (Overlap& pair : *pairs) pair = {own[pair.first], own[pair.second], pair.area};
    return pairs;
  }

  // Which faces of a piece are on the first side of the shortest cut between its two ends, a quarter of the triangles
  // each, or one face.
  Array<char> halves(const Array<Index>& piece) {
    const Array<Index> order = by_distance(by_distance(piece.front(), piece).back(), piece);
    std::size_t total = 0;
    for (const Index face : piece) total += triangles_[face].size();
    const auto quarter = [&](const auto& begin, const auto& end) {
      Array<Index> out{*begin};
      std::size_t count = triangles_[*begin].size();
      for (auto at = begin + 1; at != end; ++at) {
        count += triangles_[*at].size();
        if (4 * count > total) break;
        out.push_back(*at);
      }
      return out;
    };
    return cutter_.cut(piece, quarter(order.begin(), order.end()), quarter(order.rbegin(), order.rend())).is_first;
  }

  // Faces of a piece, those beside a face first; what is not connected to it comes last.
  Array<Index> by_distance(Index from, const Array<Index>& piece) {
    for (const Index face : piece) is_waiting_[face] = 1;
    Array<Index> order{from};
    is_waiting_[from] = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      graph_.for_each_link(order[i], [&](Index other, const FaceGraph::Link&) {
        if (!is_waiting_[other]) return;
        is_waiting_[other] = 0;
        order.push_back(other);
      });
    }
    for (const Index face : piece) {
      if (!is_waiting_[face]) continue;
      is_waiting_[face] = 0;
      order.push_back(face);
    }
    return order;
  }

  const MapLayout& layout_;
  const FaceGraph graph_;
  PerFace<Array<Index>> triangles_;
  PerTriangle<Index> place_;  // in a piece; none between calls
  PerFace<char> is_waiting_;  // 0 between calls
  MinimumCutter cutter_;
};

}  // namespace

OwnOverlaps find_own_overlaps(const OpenedSurface& surface, const ComponentMap& map) {
  const MapLayout layout = layout_of(surface.mesh, map);
  const std::size_t most = crowded * static_cast<std::size_t>(surface.mesh.triangle_count());
  if (auto pairs = find_few_overlaps(layout.corners, layout.twin, most, {})) return {std::move(*pairs), {}};
  return PieceHalver(surface, layout).halve();
}

bool overlaps_itself(const HalfedgeMesh& mesh, const ComponentMap& map) {
  const MapLayout layout = layout_of(mesh, map);
  return !find_few_overlaps(layout.corners, layout.twin, 0, {});
}

}  // namespace lsgp
