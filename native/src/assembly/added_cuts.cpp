// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/added_cuts.hpp"

#include <algorithm>
#include <string>

#include "base/text.hpp"

namespace lsgp {

void AddedCuts::add(const Component& component, const ComponentMap& map) {
  const HalfedgeMesh& mesh = component.mesh;
  if (std::find(mesh.seam.begin(), mesh.seam.end(), 1) == mesh.seam.end()) return;
  const std::size_t before = edges_.size();
  for (const Index h : map.required_cuts) {
    if (mesh.seam[h] || !map.cut_graph.is_cut[h]) continue;
    edges_.push_back(component.source_vertex[mesh.origin(h)]);
    edges_.push_back(component.source_vertex[mesh.target(h)]);
  }
  if (edges_.size() == before) return;
  const bool has_cones = !map.cones.empty();
  open_handles_ = open_handles_ || mesh.genus > 0;
  reach_cones_ = reach_cones_ || has_cones;
  open_holes_ = open_holes_ || (mesh.genus == 0 && !has_cones);
}

void AddedCuts::report(std::vector<Finding>& findings) const {
  if (edges_.empty()) return;
  std::string why;
  const auto add_reason = [&](bool holds, const char* reason) {
    if (holds) why += (why.empty() ? "" : ", and ") + std::string(reason);
  };
  add_reason(reach_cones_, "to reach cones and boundaries");
  add_reason(open_handles_, "to open handles");
  add_reason(open_holes_, "because components with holes would be stretched too much otherwise");
  const std::size_t edge_count = edges_.size() / 2;
  findings.push_back({Code::cuts_added,
                      concat(count(edge_count, "edge was", "edges were"), " cut besides the marked seams, ", why,
                             ". Mark seams there to choose other routes."),
                      {ElementKind::edges, edges_}});
}

}  // namespace lsgp
