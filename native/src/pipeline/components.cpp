// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/components.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "base/text.hpp"
#include "cut/parts.hpp"
#include "pipeline/said_once.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "plane/point_lattice.hpp"

namespace lsgp {

namespace {

constexpr auto no_area = "No triangle has an area. Restore the surface's shape.";

Finding left_out(Code code, const char* why, Array<Index> triangles) {
  return {Code::component_skipped,
          concat("A component of the surface was left out (", name(code), "): ", why),
          {ElementKind::triangles, std::move(triangles)}};
}

// The vertices inside one of the components. A cone there is none of the borders of others that end or touch there.
PerVertex<char> mark_inside(const PerComponent<Component>& components, Eigen::Index vertex_count) {
  PerVertex<char> out(vertex_count, 0);
  for (const Component& component : components) {
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      if (component.mesh.loop_of_vertex[v] == none) out[component.source_vertex[v]] = 1;
    }
  }
  return out;
}

// open: the components that are opened along their seams.
PerComponent<ComponentTask> hand_out(const Surface& surface, const PerComponent<Component>& components,
                                     const OpenSeams& open, const Cones& cones, const Options& options) {
  PerVertex<Index> cone_at(surface.positions.rows(), none);
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) cone_at[cones.vertices[i]] = static_cast<Index>(i);
  const PerVertex<char> is_inside = mark_inside(components, surface.positions.rows());
  PerComponent<ComponentTask> tasks(components.size());
  for (std::size_t c = 0; c < components.size(); ++c) {
    const Component& component = components[c];
    ComponentCones& own = tasks[c].cones;
    own.border = options.border == BorderMode::straight ? BorderMode::straight : BorderMode::free;
    if (!open.empty() && open[component.source_triangle.front()]) own.holes = Holes::all;
    if (options.seamless) own.rotation_order = rotation_order(options.seamless->lattice);
    own.loop_turning.resize(component.mesh.boundary_loops.size());
    Array<std::pair<Index, Index>> found;  // place in the caller's list, vertex
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      const Index cone = cone_at[component.source_vertex[v]];
      if (cone == none) continue;
      if (component.mesh.loop_of_vertex[v] != none && is_inside[component.source_vertex[v]]) continue;
      const bool imposed = options.prescription == PrescriptionRule::manual && element(cones.angles, cone);
      const bool corner = options.border == BorderMode::straight || imposed;
      if (component.mesh.loop_of_vertex[v] == none || corner)
        found.emplace_back(cone, v);
      else
        tasks[c].border_cones.push_back(v);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [cone, v] : found) {
      own.vertices.push_back(v);
      own.angles.push_back(element(cones.angles, cone));
    }
    const bool is_marked = component.mesh.is_disk()
                               ? tasks[c].is_marked_inside(component.mesh)
                               : tasks[c].is_marked(component.mesh) || options.seams == SeamMode::exact;
    tasks[c].may_be_strip = options.border == BorderMode::strips && !is_marked;
  }
  return tasks;
}

void hand_out_turning(const PerComponent<Component>& components, const Options& options, Eigen::Index vertex_count,
                      PerComponent<ComponentTask>& tasks) {
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
        concat("The prescribed turning of a boundary is ",
               found ? "not a finite number" : "given at a vertex that is not on a boundary",
               exists ? "" : concat(" (", vertex, ")"), ". Give an angle in radians and a vertex on the boundary."),
        {ElementKind::vertices, exists ? Array<Index>{vertex} : Array<Index>{}});
  }
}

void hand_out_pins(const Surface& surface, const Pins& pins, Work& work) {
  if (pins.corners.empty()) return;
  PerHalfedge<Index> pin_at(3 * surface.triangles.rows(), none);
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

// The sum of the curvatures of a component's cones; none if it is not determined.
std::optional<double> given_curvature(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  double sum = 0;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    if (!cones.angles[i] || mesh.loop_of_vertex[cones.vertices[i]] != none) return std::nullopt;
    sum += 2 * M_PI - *cones.angles[i];
  }
  return sum;
}

void hand_out_directions(const Positions& directions, const Options& options, Work& work) {
  if (directions.rows() == 0) return;
  for (std::size_t c = 0; c < work.tasks.size(); ++c) {
    const Component& component = work.topology.components[c];
    ComponentTask& task = work.tasks[c];
    const Positions own = directions_on(component, directions);
    task.directions = directions_in_triangles(component.mesh, own);
    const std::optional<double> curvature = given_curvature(component.mesh, task.cones);
    // A single boundary turns by the curvature inside in any case.
    if (options.seamless && curvature && component.mesh.boundary_loops.size() > 1) {
      task.has_directed_borders =
          let_borders_run_along(component.mesh, own, task.cones.rotation_order, curvature, task.cones);
    }
  }
}

// The power of two that brings the surface's metric to about unit size: exact, and areas can neither overflow nor
// vanish.
double unit_scale(const Surface& surface) {
  double largest = 0;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    const auto corner = surface.positions.row(surface.triangles(f, 0));
    for (const int c : {1, 2}) {
      const double size = (surface.positions.row(surface.triangles(f, c)) - corner).cwiseAbs().maxCoeff();
      largest = std::max(largest, size * edge_scale(surface.scale, surface.triangles(f, 0), surface.triangles(f, c)));
    }
  }
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

// Collapsed triangles, and those among them that have no neighbor with a map.
void report_collapsed(const Topology& topology, std::vector<Finding>& findings) {
  const Array<Index>& collapsed = topology.collapsed;
  if (collapsed.empty()) return;
  findings.push_back(counted(Code::degenerate_faces, {ElementKind::triangles, collapsed}));
  Array<Index> neighbors, alone;
  for (const auto& pair : topology.duplicates) neighbors.push_back(pair.first);
  sort_unique(neighbors);
  std::set_difference(collapsed.begin(), collapsed.end(), neighbors.begin(), neighbors.end(),
                      std::back_inserter(alone));
  if (!alone.empty()) findings.push_back(left_out(Code::degenerate_mesh, no_area, std::move(alone)));
}

// Whether seams are boundaries of components without cones.
bool opens_some(SeamMode seams) { return seams == SeamMode::follow || seams == SeamMode::exact; }

// Builds the components of the surface unless they are up to date.
void split(const Surface& surface, SeamMode seams, OpenSeams open, Work& work) {
  if (!work.topology.components.empty() && work.seams == seams && work.open_seams == open) return;
  Surface used = surface;
  work.unit_scale = unit_scale(surface);
  used.positions *= work.unit_scale;
  if (seams == SeamMode::ignore) used.seams.resize(0, 2);
  const bool was_unopened = work.seams == seams && work.open_seams.empty();
  if (!opens_some(seams) || open.empty()) work.unopened.clear();
  if (opens_some(seams) && !open.empty() && was_unopened) work.unopened = std::move(work.topology.components);
  work.found.clear();
  work.topology = build_topology(used, open, work.found);
  report_collapsed(work.topology, work.found);
  ++work.generation;
  work.seams = seams;
  work.open_seams = std::move(open);
}

// The triangles of components that are opened along their seams.
struct Opened {
  Array<Index> without_cones, not_orientable;
};

// Of a component that is not orientable, which has no mesh, whether it has one of the seams, the lower vertex first.
bool has_seam(const Surface& surface, const Component& component, const std::set<std::pair<Index, Index>>& seams) {
  const auto is_seam = [&](Index a, Index b) { return seams.count(std::minmax(a, b)) > 0; };
  return std::any_of(component.source_triangle.begin(), component.source_triangle.end(), [&](Index f) {
    const auto v = surface.triangles.row(f);
    return is_seam(v[0], v[1]) || is_seam(v[1], v[2]) || is_seam(v[2], v[0]);
  });
}

Opened find_opened(const Surface& surface, const PerComponent<Component>& components,
                   const PerComponent<ComponentTask>& tasks, const Options& options, MoreCones more) {
  Opened out;
  if (surface.seams.rows() == 0) return out;
  std::set<std::pair<Index, Index>> seams;
  for (Index i = 0; i < surface.seams.rows(); ++i) seams.insert(std::minmax(surface.seams(i, 0), surface.seams(i, 1)));
  for (std::size_t c = 0; c < tasks.size(); ++c) {
    const Array<Index>& triangles = components[c].source_triangle;
    const auto add_to = [&](Array<Index>& list) { list.insert(list.end(), triangles.begin(), triangles.end()); };
    if (!components[c].orientable) {
      if (has_seam(surface, components[c], seams)) add_to(out.not_orientable);
    } else if (more == MoreCones::none && opens_along_seams(components[c], tasks[c].cones, options)) {
      add_to(out.without_cones);
    }
  }
  return out;
}

void divide(const Request& request, MoreCones more, std::vector<Finding>& findings, Work& work) {
  const auto& [surface, cones, options] = request;
  const auto split_along = [&, &surface = surface, &cones = cones, &options = options](OpenSeams open) {
    split(surface, options.seams, std::move(open), work);
    work.tasks = hand_out(surface, work.topology.components, work.open_seams, cones, options);
  };
  if (!opens_some(options.seams)) {
    const bool opens_all = options.seams == SeamMode::boundary;
    return split_along(opens_all ? OpenSeams(surface.triangles.rows(), 1) : OpenSeams());
  }
  Opened opened;
  if (work.seams == options.seams && !work.unopened.empty()) {
    const PerComponent<ComponentTask> tasks = hand_out(surface, work.unopened, {}, cones, options);
    opened = find_opened(surface, work.unopened, tasks, options, more);
  } else {
    split_along({});
    opened = find_opened(surface, work.topology.components, work.tasks, options, more);
  }
  OpenSeams open;
  for (const Array<Index>* list : {&opened.without_cones, &opened.not_orientable}) {
    if (!list->empty()) open.resize(surface.triangles.rows(), 0);
    for (const Index f : *list) open[f] = 1;
  }
  split_along(std::move(open));
  const auto report = [&](Array<Index>& triangles, const char* sentence) {
    if (triangles.empty() || request.options.seams == SeamMode::exact) return;
    findings.push_back({Code::seams_opened, sentence, {ElementKind::triangles, std::move(triangles)}});
  };
  report(opened.without_cones,
         "A component has seams but no cones: it was opened along its seams as in an ordinary unwrap. Mark cones if "
         "the texture should continue across them.");
  report(opened.not_orientable,
         "A component is one-sided: it was opened along its seams as in an ordinary unwrap, since no texture can "
         "continue across all of them.");
}

// A torus without cones is flat, and its texture continues across its seams, unless these divide it into planar pieces
// some of which have holes: those need no cut of their own if the torus is opened.
bool is_flat_along_seams(const HalfedgeMesh& torus) {
  const PerPart<PartTopology> parts = measure_parts(torus, torus.seam);
  const bool all_planar = std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.is_planar(); });
  const bool all_disks = std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.is_disk(); });
  return parts.size() == 1 || all_disks || !all_planar;
}

}  // namespace

bool ComponentTask::is_marked(const HalfedgeMesh& mesh) const {
  return !cones.vertices.empty() || !border_cones.empty() ||
         std::find(mesh.seam.begin(), mesh.seam.end(), 1) != mesh.seam.end();
}

bool ComponentTask::is_marked_inside(const HalfedgeMesh& disk) const {
  for (Index h = 0; h < disk.halfedge_count(); ++h) {
    if (disk.seam[h] && disk.twin[h] != none) return true;
  }
  return !cones.vertices.empty() || !border_cones.empty();
}

Work prepare_placement(const PlacementRequest& request, std::vector<Finding>& findings, Work earlier) {
  if (earlier.topology.components.empty()) require_valid(request.surface);
  require_valid(request.surface, request.existing);
  Options options;
  options.prescription = PrescriptionRule::manual;
  options.seams = request.seams;
  options.border = request.border;
  Work work = std::move(earlier);
  divide({request.surface, request.existing, options}, request.more, findings, work);
  findings.insert(findings.end(), work.found.begin(), work.found.end());
  return work;
}

Work prepare(const Request& request, std::vector<Finding>& findings, const Pins& pins, Work earlier) {
  const auto& [surface, cones, options] = request;
  if (earlier.topology.components.empty()) require_valid(surface);
  require_valid(surface, cones);
  require_valid(surface, pins);
  require_valid(options, pins);
  Work work = std::move(earlier);
  divide(request, MoreCones::none, findings, work);
  hand_out_pins(surface, pins, work);
  hand_out_importance(surface.importance, work);
  hand_out_turning(work.topology.components, options, surface.positions.rows(), work.tasks);
  hand_out_directions(surface.directions, options, work);
  for (ComponentTask& task : work.tasks) {
    const auto is_given = [](const std::optional<double>& turning) { return turning.has_value(); };
    const PerLoop<std::optional<double>>& turning = task.cones.loop_turning;
    task.may_be_strip &= task.pinned_corners.empty() && std::none_of(turning.begin(), turning.end(), is_given);
  }
  findings.insert(findings.end(), work.found.begin(), work.found.end());
  return work;
}

Work prepare_topology(const Request& request, MoreCones more) {
  require_connectivity(request.surface);
  require_vertices(request.surface, request.cones);
  std::vector<Finding> findings;
  Work work;
  divide(request, more, findings, work);
  return work;
}

Positions directions_on(const Component& component, const Positions& directions) {
  Positions out(static_cast<Index>(component.source_triangle.size()), 3);
  for (Index f = 0; f < out.rows(); ++f) out.row(f) = directions.row(component.source_triangle[f]);
  return out;
}

bool let_borders_run_along(const HalfedgeMesh& mesh, const Positions& directions, int rotation_order,
                           std::optional<double> curvature, ComponentCones& cones) {
  const auto is_given = [](const std::optional<double>& turning) { return turning.has_value(); };
  if (mesh.closed() || std::any_of(cones.loop_turning.begin(), cones.loop_turning.end(), is_given)) return false;
  const PerLoop<std::optional<double>> wanted = turning_beside(mesh, directions, rotation_order);
  if (!std::all_of(wanted.begin(), wanted.end(), is_given)) return false;
  double missing = 2 * M_PI * mesh.euler - curvature.value_or(0);
  for (const auto& turning : wanted) missing -= *turning;
  if (curvature && std::abs(missing) > M_PI / rotation_order) return false;
  cones.loop_turning = wanted;
  return true;
}

void become_strip(ComponentTask& tube) {
  tube.is_strip = true;
  PerLoop<std::optional<double>>& turning = tube.cones.loop_turning;
  if (turning.size() > 1) std::fill(turning.begin(), turning.end(), 0.0);
}

bool opens_along_seams(const Component& component, const ComponentCones& cones, const Options& options) {
  const HalfedgeMesh& mesh = component.mesh;
  if (!opens_some(options.seams) || !component.orientable || !cones.vertices.empty()) return false;
  bool has_seam = false;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) has_seam |= mesh.seam[h] && mesh.twin[h] != none;
  if (!has_seam || options.seams == SeamMode::exact) return has_seam;
  // Straight boundaries need corners, which pieces would not have, and tiles continue across seams.
  if (!mesh.closed() && (options.border == BorderMode::straight || options.seamless)) return false;
  return !(mesh.closed() && mesh.euler == 0 && is_flat_along_seams(mesh));
}

Geometry require_geometry(const Component& component, std::vector<Finding>& findings) {
  if (!component.orientable) {
    Array<Index> all(component.source_triangle.size());
    for (std::size_t f = 0; f < all.size(); ++f) all[f] = static_cast<Index>(f);
    throw Error(Code::not_orientable,
                "The surface has one side only, like a Moebius strip, so no side of it can be unwrapped face up. "
                "Delete or split faces so that it has two sides, or unwrap it with a preset and without cones, which "
                "cuts it open.",
                {ElementKind::triangles, std::move(all)});
  }
  Geometry geometry = build_geometry(component.mesh);
  if (geometry.degenerate.empty()) return geometry;
  if (geometry.degenerate.size() == component.source_triangle.size()) {
    throw Error(Code::degenerate_mesh, no_area, {ElementKind::triangles, geometry.degenerate});
  }
  require_comparable(component.mesh.positions);  // distant outliers have only degenerate triangles
  findings.push_back(
      counted(Code::degenerate_faces, in_source(component, {ElementKind::triangles, geometry.degenerate})));
  return geometry;
}

Elements in_source(const Component& component, Elements elements) {
  const bool are_triangles = elements.kind == ElementKind::triangles;
  for (Index& i : elements.indices) i = are_triangles ? component.source_triangle[i] : component.source_vertex[i];
  // Fans of one vertex are several of the component's.
  if (elements.kind == ElementKind::vertices) sort_unique(elements.indices);
  return elements;
}

void report_border_cones(const Component& component, const Array<Index>& border_cones, std::vector<Finding>& findings) {
  if (border_cones.empty()) return;
  findings.push_back(counted(Code::cone_on_boundary, in_source(component, {ElementKind::vertices, border_cones})));
}

Failure failure_of(const Component& component, const Error& error) {
  if (error.code() == Code::cancelled) throw error;
  return {&component, Error(error.code(), in_words(error).what(), in_source(component, error.elements()))};
}

void report_skipped(const Array<Failure>& failures, std::vector<Finding>& findings) {
  for (const auto& [component, error] : failures) {
    const Elements& elements = error.elements();
    if (error.code() == Code::seams_incomplete) findings.push_back({error.code(), error.what(), elements});
    findings.push_back(left_out(error.code(), error.what(), component->source_triangle));
  }
}

void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to) {
  for (Finding& finding : from) {
    to.push_back({finding.code, std::move(finding.message), in_source(component, std::move(finding.elements))});
  }
}

}  // namespace lsgp
