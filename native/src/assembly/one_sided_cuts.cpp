// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/one_sided_cuts.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "split/mirrored_islands.hpp"

namespace lsgp {

void OneSidedCuts::add(const Component& component, const Geometry& geometry, const Mirroring& mirroring,
                       const ComponentMap& map) {
  if (!are_mirrored(mirroring, map.cones)) return;
  const HalfedgeMesh& mesh = component.mesh;
  PerHalfedge<char> open = map.cut_graph.is_cut;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) open[h] = open[h] || mesh.seam[h];
  const Array<Index> edges = MirroredIslands({mesh, geometry}, mirroring).one_sided_edges(open);
  const std::size_t before = edges_.size();
  for (const Index h : edges) {
    if (mesh.seam[h]) continue;
    edges_.push_back(component.source_vertex[mesh.origin(h)]);
    edges_.push_back(component.source_vertex[mesh.target(h)]);
    one_sided_ += geometry.length[h];
  }
  if (edges_.size() == before) return;
  for (const Index h : halfedges_of(map.cut_graph)) in_all_ += geometry.length[h];
}

void OneSidedCuts::report(std::vector<Finding>& findings) const {
  if (edges_.empty()) return;
  const double percent = std::max(1.0, std::round(100 * one_sided_ / in_all_));
  findings.push_back({Code::cuts_not_mirrored,
                      concat(count(edges_.size() / 2, "cut edge has", "cut edges have"), " no mirror image, ", percent,
                             " % of the length of the cuts: they would enclose a piece together with it, or it would "
                             "cost much longer cuts or more islands. Mark seams on both sides to choose other routes."),
                      {ElementKind::edges, edges_}});
}

}  // namespace lsgp
