// SPDX-License-Identifier: GPL-3.0-or-later
// Splits the caller's surface into components, and renames what is found there into the caller's numbering.
#pragma once

#include <cstdint>
#include <string>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "mesh/topology.hpp"
#include "prescription/curvature.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

// What the caller asks of one component, in its own numbering.
struct ComponentTask {
  ComponentCones cones;                             // in the caller's order
  Array<Index> border_cones;                        // vertices of cones on a free border that prescribe nothing
  Array<std::pair<Index, Complex>> pinned_corners;  // and their places
  Eigen::VectorXd importance;                       // (n) weights of stretch, or empty
  TextureDirections directions;                     // or none
};

// A surface's components and the task of each.
struct Work {
  Topology topology;
  Array<ComponentTask> tasks;  // (components)
  double unit_scale = 1;       // of the components' positions to the caller's

  // Incremented whenever the topology is rebuilt; derived data is valid while it is unchanged.
  std::int64_t generation = 0;

  // The input that the topology was built for, and the findings of building it.
  SeamMode seams = SeamMode::follow;
  OpenSeams open_seams;
  Array<Component> unopened;  // before some of them were opened along seams that are followed, if any were
  std::vector<Finding> found;
};

// What a caller asks of a surface.
struct Request {
  const Surface& surface;
  const Cones& cones;
  const Options& options;
};

// Validates the call, splits the surface as the seam mode says and hands out what is asked.
//
// What becomes of seams is decided here, for all verbs. Where they are followed they are where cuts run, and cuts join
// cones: a component that has cones, or is to get some, stays as it is, and its texture runs on across its seams. One
// without cones is opened along its seams, as an artist who marked seams means it.
// earlier: of the same surface, or empty; its topology is taken where it would come out the same.
// Throws what require_valid and build_topology throw, and LOOP_TURNING.
Work prepare(const Request& request, std::vector<Finding>& findings, const Pins& pins = {}, Work earlier = {});

// The same for cones that are to be placed.
enum class MoreCones { none, some };
struct PlacementRequest {
  const Surface& surface;
  const Cones& existing;  // given angles stay
  SeamMode seams;
  MoreCones more;
};
Work prepare_placement(const PlacementRequest& request, std::vector<Finding>& findings);

// The same for what needs no positions: these are not looked at.
Work prepare_topology(const Request& request, MoreCones more);

// (m, 3) those of a component's triangles.
Positions directions_on(const Component& component, const Positions& directions);

// Has borders of a component turn so that a seamless layout runs along directions: a sleeve becomes a strip. Only where
// nothing else is asked for and they all can, with this sum of the cones' curvatures; none: which can follow from it.
// Returns whether it does.
bool let_borders_run_along(const HalfedgeMesh& mesh, const Positions& directions, int symmetry,
                           std::optional<double> curvature, ComponentCones& cones);

// Whether seams that are followed are borders of this component, for want of cones.
bool opens_along_seams(const Component& component, const ComponentCones& cones, const Options& options);

// Throws NOT_ORIENTABLE, DEGENERATE_MESH, SCALE_RANGE.
Geometry require_geometry(const Component& component, std::vector<Finding>& findings);

// Renames a component's vertices, triangles or edges into the caller's.
Elements in_source(const Component& component, Elements elements);

// Names cones on a free border, which prescribe nothing.
void report_border_cones(const Component& component, const Array<Index>& border_cones, std::vector<Finding>& findings);

// Hands findings on in the caller's numbering.
void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to);

// Why a component has no map, in the caller's numbering.
struct Failure {
  const Component* component;
  Error error;
};
// Throws the error where the work has to end: CANCELLED.
Failure failure_of(const Component& component, const Error& error);

// Names failures as COMPONENT_SKIPPED.
void report_skipped(const Array<Failure>& failures, std::vector<Finding>& findings);

// Runs solve(component index) for every component. One that throws is reported as COMPONENT_SKIPPED, unless all do:
// then the first error is thrown in the caller's numbering.
template <typename Solve>
void for_each_component(const Array<Component>& components, std::vector<Finding>& findings, Solve solve) {
  Array<Failure> failures;
  for (std::size_t i = 0; i < components.size(); ++i) {
    try {
      solve(i);
    } catch (const Error& error) {
      failures.push_back(failure_of(components[i], error));
      if (failures.size() == components.size()) throw failures.front().error;
    }
  }
  report_skipped(failures, findings);
}

// The same, telling the monitor that all take as long as each other.
template <typename Solve>
void for_each_component(const Array<Component>& components, std::vector<Finding>& findings, ProgressMonitor& monitor,
                        Solve solve) {
  const double count = static_cast<double>(components.size());
  for_each_component(components, findings, [&](std::size_t i) {
    const double begin = static_cast<double>(i) / count, end = static_cast<double>(i + 1) / count;
    monitor.advance(begin);
    const ProgressMonitor::Part part(monitor, begin, end);
    solve(i);
  });
}

}  // namespace lsgp
