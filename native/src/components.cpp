// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"

#include <algorithm>

#include "text.hpp"

namespace lsgp {

std::vector<AssignedCones> assign_cones(const Surface& surface, const std::vector<Component>& components,
                                        const Cones& cones) {
  std::vector<Index> cone_at(surface.positions.rows(), none);
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) cone_at[cones.vertices[i]] = static_cast<Index>(i);
  std::vector<AssignedCones> assigned(components.size());
  for (std::size_t c = 0; c < components.size(); ++c) {
    const Component& component = components[c];
    if (!component.orientable) continue;
    std::vector<std::pair<Index, Index>> inside;  // place in the caller's list, vertex
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      const Index cone = cone_at[component.source_vertex[v]];
      if (cone == none) continue;
      if (component.mesh.loop_of_vertex[v] == none)
        inside.emplace_back(cone, v);
      else
        assigned[c].on_boundary.push_back(v);
    }
    std::sort(inside.begin(), inside.end());
    for (const auto& [cone, v] : inside) {
      assigned[c].inside.vertices.push_back(v);
      assigned[c].inside.angles.push_back(cones.angles[cone]);
    }
  }
  return assigned;
}

Geometry require_geometry(const Component& component, std::vector<Finding>& findings) {
  if (!component.orientable) {
    std::vector<Index> all(component.source_triangle.size());
    for (std::size_t f = 0; f < all.size(); ++f) all[f] = static_cast<Index>(f);
    throw Error(Code::not_orientable,
                "The surface has one side only, like a Moebius strip, so no side of it can be unwrapped face up. "
                "Delete or split faces so that it has two sides.",
                {ElementKind::triangles, std::move(all)});
  }
  Geometry geometry = build_geometry(component.mesh);
  if (geometry.degenerate.empty()) return geometry;
  if (geometry.degenerate.size() == component.source_triangle.size()) {
    throw Error(
        Code::degenerate_mesh,
        concat("None of the ", geometry.degenerate.size(), " triangles has an area. Restore the surface's shape."),
        {ElementKind::triangles, geometry.degenerate});
  }
  findings.push_back(
      {Code::degenerate_faces,
       concat(count(geometry.degenerate.size(), "triangle has", "triangles have"),
              " no area; they were given a little for the computation. Merge by distance to be rid of them."),
       in_source(component, {ElementKind::triangles, geometry.degenerate})});
  return geometry;
}

Elements in_source(const Component& component, Elements elements) {
  const auto& source = elements.kind == ElementKind::triangles ? component.source_triangle : component.source_vertex;
  for (Index& i : elements.indices) i = source[i];
  return elements;
}

StageTimer::~StageTimer() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  for (auto& [stage, total] : stages_) {
    if (stage == stage_) {
      total += seconds;
      return;
    }
  }
  stages_.emplace_back(stage_, seconds);
}

}  // namespace lsgp
