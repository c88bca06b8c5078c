// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/aligned_lines.hpp"

#include <algorithm>
#include <functional>

namespace lsgp {

namespace {

constexpr int most_rings = 4;             // of triangles from where lines fail to the next line
constexpr Index most_defects = 24;        // vertices there, on small meshes
constexpr double defective_share = 0.02;  // of the vertices, on others

// Marks the neighbors of marked vertices.
void grow(const HalfedgeMesh& mesh, PerVertex<char>& is_marked) {
  const PerVertex<char> inner = is_marked;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (inner[mesh.origin(h)]) is_marked[mesh.target(h)] = 1;
    if (inner[mesh.target(h)]) is_marked[mesh.origin(h)] = 1;
  }
}

FeatureLine part_of(const FeatureLine& line, const Geometry& geometry, const std::function<bool(Index)>& is_in) {
  FeatureLine out = line;
  out.halfedges.clear();
  out.directions.clear();
  out.length = 0;
  for (Index i = 0; i < ssize(line.halfedges); ++i) {
    const Index h = line.halfedges[i];
    if (!is_in(h)) continue;
    out.halfedges.push_back(h);
    out.directions.push_back(line.directions[i]);
    out.length += geometry.length[h];
  }
  out.is_whole = line.is_whole && out.halfedges.size() == line.halfedges.size();
  return out;
}

}  // namespace

std::pair<double, double> length_of(const Array<FeatureLine>& lines) {
  std::pair<double, double> out(0, 0);
  for (const FeatureLine& line : lines) (line.is_marked ? out.first : out.second) += line.length;
  return out;
}

double total_length(const Array<FeatureLine>& lines) {
  const auto [of_marked, of_others] = length_of(lines);
  return of_marked + of_others;
}

DirectedEdges edges_of(const Array<FeatureLine>& lines) {
  DirectedEdges out;
  for (const FeatureLine& line : lines) {
    out.halfedges.insert(out.halfedges.end(), line.halfedges.begin(), line.halfedges.end());
    out.directions.insert(out.directions.end(), line.directions.begin(), line.directions.end());
  }
  return out;
}

void release(Index h, ReleaseReason reason, PerHalfedge<ReleaseReason>& reasons) {
  if (reasons[h] != ReleaseReason::curved) reasons[h] = reason;
}

bool are_few(const Array<Index>& vertices, const HalfedgeMesh& mesh) {
  const auto share = static_cast<Index>(defective_share * mesh.vertex_count());
  return ssize(vertices) <= std::max(most_defects, share);
}

bool trim(const MetricMesh& surface, const LineFailure& failure, Array<FeatureLine>& lines,
          Array<FeatureLine>* released) {
  const HalfedgeMesh& mesh = surface.mesh;
  if (failure.vertices.empty() || !are_few(failure.vertices, mesh)) return false;
  PerVertex<char> is_marked(mesh.vertex_count(), 0);
  for (const Index v : failure.vertices) is_marked[v] = 1;
  const auto is_released = [&](Index h) { return is_marked[mesh.origin(h)] || is_marked[mesh.target(h)]; };
  const auto is_trimmed = [&](const FeatureLine& line) {
    return std::any_of(line.halfedges.begin(), line.halfedges.end(), is_released);
  };
  for (int ring = 0; ring < most_rings && std::none_of(lines.begin(), lines.end(), is_trimmed); ++ring) {
    grow(mesh, is_marked);
  }
  bool has_released = false, has_others = false;
  for (FeatureLine& line : lines) {
    const bool is_lost = failure.is_of_lines && is_trimmed(line);
    const auto is_gone = [&](Index h) { return is_lost || is_released(h); };
    FeatureLine left = part_of(line, surface.geometry, [&](Index h) { return !is_gone(h); });
    const FeatureLine before = std::exchange(line, std::move(left));
    has_others = has_others || !line.halfedges.empty();
    if (line.is_whole || line.halfedges.size() == before.halfedges.size()) continue;
    has_released = true;
    if (released != nullptr) released->push_back(part_of(before, surface.geometry, is_gone));
  }
  return has_released && has_others;
}

}  // namespace lsgp
