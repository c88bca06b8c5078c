// SPDX-License-Identifier: GPL-3.0-or-later
#include "components.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "point_lattice.hpp"
#include "text.hpp"
#include "validation.hpp"

namespace lsgp {

namespace {

std::vector<ComponentTask> hand_out(const Surface& surface, const std::vector<Component>& components,
                                    const Cones& cones, const Options& options) {
  std::vector<Index> cone_at(surface.positions.rows(), none);
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) cone_at[cones.vertices[i]] = static_cast<Index>(i);
  std::vector<ComponentTask> tasks(components.size());
  for (std::size_t c = 0; c < components.size(); ++c) {
    const Component& component = components[c];
    ComponentCones& own = tasks[c].cones;
    own.border = options.border;
    if (options.seamless) own.symmetry = symmetry(options.seamless->lattice);
    own.loop_turning.resize(component.mesh.boundary_loops.size());
    std::vector<std::pair<Index, Index>> found;  // place in the caller's list, vertex
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      const Index cone = cone_at[component.source_vertex[v]];
      if (cone == none) continue;
      const bool imposed = options.prescription == PrescriptionRule::manual && cones.angles[cone];
      const bool corner = options.border == BorderMode::straight || imposed;
      if (component.mesh.loop_of_vertex[v] == none || corner)
        found.emplace_back(cone, v);
      else
        tasks[c].border_cones.push_back(v);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [cone, v] : found) {
      own.vertices.push_back(v);
      own.angles.push_back(cones.angles[cone]);
    }
  }
  return tasks;
}

void hand_out_turning(const std::vector<Component>& components, const Options& options, Eigen::Index vertex_count,
                      std::vector<ComponentTask>& tasks) {
  for (const auto& [vertex, turning] : options.loop_turning) {
    bool found = false;
    for (std::size_t c = 0; c < components.size(); ++c) {
      const Component& component = components[c];
      for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
        const Index loop = component.source_vertex[v] == vertex ? component.mesh.loop_of_vertex[v] : none;
        if (loop == none) continue;
        tasks[c].cones.loop_turning[loop] = turning;
        found = true;
      }
    }
    if (found && std::isfinite(turning)) continue;
    const bool exists = vertex >= 0 && vertex < vertex_count;
    throw Error(
        Code::loop_turning,
        concat("The turning of a border was given ", found ? "as no finite number" : "for a vertex that lies on none",
               exists ? "" : concat(" (", vertex, ")"), ". Give an angle, by a vertex on the border."),
        {ElementKind::vertices, exists ? std::vector<Index>{vertex} : std::vector<Index>{}});
  }
}

void hand_out_pins(const Surface& surface, const Pins& pins, Work& work) {
  if (pins.corners.empty()) return;
  std::vector<Index> pin_at(3 * surface.triangles.rows(), none);
  for (std::size_t i = 0; i < pins.corners.size(); ++i) pin_at[pins.corners[i]] = static_cast<Index>(i);
  for (std::size_t c = 0; c < work.tasks.size(); ++c) {
    const Component& component = work.topology.components[c];
    for (Index corner = 0; corner < component.mesh.halfedge_count(); ++corner) {
      const Index pin = pin_at[component.source_corner(corner)];
      if (pin == none) continue;
      work.tasks[c].pinned_corners.emplace_back(corner, Complex(pins.positions(pin, 0), pins.positions(pin, 1)));
    }
  }
}

void hand_out_importance(const Eigen::VectorXd& importance, Work& work) {
  if (importance.size() == 0) return;
  for (std::size_t c = 0; c < work.tasks.size(); ++c) {
    const Component& component = work.topology.components[c];
    Eigen::VectorXd& own = work.tasks[c].importance;
    own.resize(component.mesh.vertex_count());
    for (Index v = 0; v < own.size(); ++v) own[v] = importance[component.source_vertex[v]];
  }
}

// The power of two that brings the surface to about unit size: exact, and areas can neither overflow nor vanish.
double unit_scale(const Surface& surface) {
  double largest = 0;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    const auto corner = surface.positions.row(surface.triangles(f, 0));
    for (const int c : {1, 2}) {
      largest = std::max(largest, (surface.positions.row(surface.triangles(f, c)) - corner).cwiseAbs().maxCoeff());
    }
  }
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

// The components of the surface, unless they are those already.
void split(const Surface& surface, SeamMode seams, OpenSeams open, Work& work) {
  if (!work.topology.components.empty() && work.seams == seams && work.open_seams == open) return;
  Surface used = surface;
  work.unit_scale = unit_scale(surface);
  used.positions *= work.unit_scale;
  if (seams == SeamMode::ignore) used.seams.resize(0, 2);
  work.found.clear();
  work.topology = build_topology(used, open, work.found);
  work.seams = seams;
  work.open_seams = std::move(open);
}

bool has_seam(const HalfedgeMesh& mesh) { return std::find(mesh.seam.begin(), mesh.seam.end(), 1) != mesh.seam.end(); }

}  // namespace

Work prepare(const Surface& surface, const Cones& cones, const Options& options, std::vector<Finding>& findings,
             const Pins& pins, Work earlier) {
  if (earlier.topology.components.empty()) require_valid(surface);
  require_valid(surface, cones);
  require_valid(surface, pins);
  require_valid(options);
  Work work = std::move(earlier);
  OpenSeams open;
  if (options.seams == SeamMode::boundary) open.assign(surface.triangles.rows(), 1);
  split(surface, options.seams, std::move(open), work);
  work.tasks = hand_out(surface, work.topology.components, cones, options);

  std::vector<Index> opened;
  for (std::size_t c = 0; c < work.tasks.size(); ++c) {
    const Component& component = work.topology.components[c];
    const bool stuck = component.orientable && component.mesh.closed() && component.mesh.euler != 0 &&
                       work.tasks[c].cones.vertices.empty();
    if (!stuck || !has_seam(component.mesh)) continue;
    opened.insert(opened.end(), component.source_triangle.begin(), component.source_triangle.end());
  }
  if (!opened.empty()) {
    open.assign(surface.triangles.rows(), 0);
    for (const Index f : opened) open[f] = 1;
    split(surface, options.seams, std::move(open), work);
    work.tasks = hand_out(surface, work.topology.components, cones, options);
    findings.push_back({Code::seams_opened,
                        "A closed part has seams but no cones: it was opened along its seams like an ordinary unwrap. "
                        "Mark cones to have the texture run on across them.",
                        {ElementKind::triangles, opened}});
  }
  hand_out_pins(surface, pins, work);
  hand_out_importance(surface.importance, work);
  hand_out_turning(work.topology.components, options, surface.positions.rows(), work.tasks);
  findings.insert(findings.end(), work.found.begin(), work.found.end());
  return work;
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
  require_comparable(component.mesh.positions);  // what lies far away has degenerate triangles only
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
  if (elements.kind == ElementKind::vertices) {  // fans of one vertex are several of the component's
    std::sort(elements.indices.begin(), elements.indices.end());
    elements.indices.erase(std::unique(elements.indices.begin(), elements.indices.end()), elements.indices.end());
  }
  return elements;
}

void report_border_cones(const Component& component, const std::vector<Index>& border_cones,
                         std::vector<Finding>& findings) {
  if (border_cones.empty()) return;
  findings.push_back(
      {Code::cone_on_boundary,
       concat(count(border_cones.size(), "cone lies", "cones lie"),
              " on an open border, where angles are free anyway; nothing was prescribed there. Give it an "
              "angle to make it a corner."),
       in_source(component, {ElementKind::vertices, border_cones})});
}

void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to) {
  for (Finding& finding : from) {
    to.push_back({finding.code, std::move(finding.message), in_source(component, std::move(finding.elements))});
  }
}

}  // namespace lsgp
