// SPDX-License-Identifier: GPL-3.0-or-later
// From the caller's surface to its components and back: every component is solved for itself.
#pragma once

#include <string>

#include "curvature.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "topology.hpp"

namespace lsgp {

// What the caller asks of one component, in its own numbering.
struct ComponentTask {
  ComponentCones cones;                                   // in the caller's order
  std::vector<Index> border_cones;                        // vertices of cones on a free border that prescribe nothing
  std::vector<std::pair<Index, Complex>> pinned_corners;  // and their places
  Eigen::VectorXd importance;                             // (n) weights of stretch, or empty
};

// A surface's components and what is asked of each.
struct Work {
  Topology topology;
  std::vector<ComponentTask> tasks;  // (components)
  double unit_scale = 1;             // of the components' positions to the caller's

  // What the topology was built for, and what building it found.
  SeamMode seams = SeamMode::follow;
  OpenSeams open_seams;
  std::vector<Finding> found;
};

// Validates the call, splits the surface as the seam mode says and hands out what is asked.  A closed
// component without cones but with seams is opened along these, as an artist who marked seams means it.
// earlier: of the same surface, or empty; its topology is taken where it would come out the same.
// Throws what require_valid and build_topology throw, and LOOP_TURNING.
Work prepare(const Surface& surface, const Cones& cones, const Options& options, std::vector<Finding>& findings,
             const Pins& pins = {}, Work earlier = {});

// Throws NOT_ORIENTABLE, DEGENERATE_MESH, SCALE_RANGE.
Geometry require_geometry(const Component& component, std::vector<Finding>& findings);

// Renames a component's vertices, triangles or edges into the caller's.
Elements in_source(const Component& component, Elements elements);

// Names cones on a free border, which prescribe nothing.
void report_border_cones(const Component& component, const std::vector<Index>& border_cones,
                         std::vector<Finding>& findings);

// Hands findings on in the caller's numbering.
void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to);

// Runs solve(component index) for every component.  One that throws is reported as COMPONENT_SKIPPED, unless all do:
// then the first error is thrown in the caller's numbering.
template <typename Solve>
void for_each_component(const std::vector<Component>& components, std::vector<Finding>& findings, Solve solve) {
  std::vector<std::pair<std::size_t, Error>> failures;
  for (std::size_t i = 0; i < components.size(); ++i) {
    try {
      solve(i);
    } catch (const Error& error) {
      if (error.code() == Code::cancelled) throw;
      failures.emplace_back(i, Error(error.code(), error.what(), in_source(components[i], error.elements())));
      if (failures.size() == components.size()) throw failures.front().second;
    }
  }
  for (const auto& [i, error] : failures) {
    findings.push_back(
        {Code::component_skipped,
         std::string("A part of the surface was left as it is (") + name(error.code()) + "): " + error.what(),
         {ElementKind::triangles, components[i].source_triangle}});
  }
}

}  // namespace lsgp
