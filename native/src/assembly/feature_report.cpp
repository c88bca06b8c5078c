// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/feature_report.hpp"

#include <algorithm>

#include "assembly/vertex_pairs.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "plane/predicates.hpp"
#include "seamless/exact_layout.hpp"

namespace lsgp {

namespace {

bool is_stored_along_axis(const CornerPositions& corners, Index h) {
  return is_along_axis(as_stored(corners[next(h)]) - as_stored(corners[h]));
}

const char* words_of(ReleaseReason reason) {
  switch (reason) {
    case ReleaseReason::curved:
      return "turn away from both axes, or are between them, where no cone or corner lets them";
    case ReleaseReason::contradiction: return "contradict others";
    case ReleaseReason::stretch: return "would cost too much stretch";
    case ReleaseReason::lattice: return "find no place on tiles of this size";
    case ReleaseReason::unsupported: return "are not aligned with these options";
  }
  return "";
}

}  // namespace

void MarkedFeatures::add(const Component& component, const ComponentMap& map, const CornerPositions& corners,
                         const Positions& positions) {
  const HalfedgeMesh& mesh = component.mesh;
  if (!mesh.has_features()) return;
  positions_ = &positions;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (!mesh.feature[h] || (twin != none && twin < h)) continue;
    auto& reason =
        edges_[std::minmax(component.source_vertex[mesh.origin(h)], component.source_vertex[mesh.target(h)])];
    if (is_stored_along_axis(corners, h) && (twin == none || is_stored_along_axis(corners, twin))) continue;
    if (!reason) reason = map.release_reasons.empty() ? ReleaseReason::unsupported : map.release_reasons[h];
  }
}

double MarkedFeatures::length_of(const std::vector<Index>& path) const {
  double out = 0;
  for (std::size_t i = 1; i < path.size(); ++i) out += (positions_->row(path[i]) - positions_->row(path[i - 1])).norm();
  return out;
}

std::optional<FeatureReport> MarkedFeatures::report(std::vector<Finding>& findings) const {
  if (positions_ == nullptr) return std::nullopt;
  FeatureReport out;
  Array<Index> edges;
  std::string reasons;
  double whole = 0;
  std::map<ReleaseReason, Array<Index>> released;
  for (const auto& [edge, reason] : edges_) {
    whole += length_of({edge.first, edge.second});
    if (reason) released[*reason].insert(released[*reason].end(), {edge.first, edge.second});
  }
  for (const auto& [reason, ends] : released) {
    double share = 0;
    const std::size_t before = out.released.size();
    for (std::vector<Index>& path : split_into_paths(to_vertex_pairs(ends), {})) {
      const double length = length_of(path);
      share += length / whole;
      out.released.push_back({std::move(path), reason, length / whole});
    }
    out.share -= share;
    reasons += concat(reasons.empty() ? "" : "; ", out.released.size() - before, " ", words_of(reason), " (",
                      rounded(100 * share, 2), " %)");
    edges.insert(edges.end(), ends.begin(), ends.end());
  }
  if (out.released.empty()) return out;
  out.share = std::max(0.0, out.share);
  findings.push_back({Code::features_released,
                      concat(count(out.released.size(), "marked feature does", "marked features do"),
                             " not run straight along u or v: ", reasons,
                             ". Unmark some, use smaller tiles, or mark cones where features turn."),
                      {ElementKind::edges, std::move(edges)}});
  return out;
}

}  // namespace lsgp
