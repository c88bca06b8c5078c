// SPDX-License-Identifier: GPL-3.0-or-later
// Splits the caller's surface into components, and translates findings into the caller's numbering.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "mesh/topology.hpp"
#include "prescription/curvature.hpp"
#include "prescription/stroke_fit.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

// The task for one component, in its own numbering.
struct ComponentTask {
  ComponentCones cones;                             // in the caller's order
  Array<Index> border_cones;                        // vertices of cones without angle on a free boundary
  Array<std::pair<Index, Complex>> pinned_corners;  // and their positions
  Eigen::VectorXd importance;                       // (n) weights of stretch, or empty
  TextureDirections directions;                     // or none
  bool has_directed_borders = false;                // whose turning follows directions, not the surface
  bool may_be_strip = false;                        // a tube without marks, if that hardly stretches it more
  bool is_strip = false;                            // and it does not: straight between its boundaries
  std::optional<double> strokes_price;              // of missing directions in choices; none: they have no effect

  // Whether there are marked cones or seams, which have precedence over what is found.
  bool is_marked(const HalfedgeMesh& mesh) const;
  // The same of the inside of a disk; the boundary of one may be of seams that it is open along.
  bool is_marked_inside(const HalfedgeMesh& disk) const;

  // What choices follow, or none.
  std::optional<FollowedStrokes> strokes() const {
    if (!strokes_price) return std::nullopt;
    return FollowedStrokes{directions, *strokes_price};
  }
};

// A surface's components and the task of each.
struct Work {
  Topology topology;
  PerComponent<ComponentTask> tasks;
  double unit_scale = 1;  // of the components' positions to the caller's

  // Incremented whenever the topology is rebuilt; derived data is valid while it is unchanged.
  std::int64_t generation = 0;

  // The input that the topology was built for, and the findings of building it.
  SeamMode seams = SeamMode::follow;
  OpenSeams open_seams;
  PerComponent<Component> unopened;  // before some of them were opened along seams, or empty
  std::vector<Finding> found;
};

// The task for a surface.
struct Request {
  const Surface& surface;
  const Cones& cones;
  const Options& options;
};

// Validates the call, splits the surface according to the seam mode and distributes the tasks.
//
// The meaning of seams is decided here, for all functions. If they are followed, cuts run along them and join cones: a
// component that has or gets cones stays whole, and its texture continues across its seams. A component without cones
// is opened along its seams, as an artist who marked seams expects. If nothing else may be cut, the same holds,
// whatever the component's boundaries and tiles are. earlier: of the same surface, or empty; its topology is reused if
// it would be the same. Throws what require_valid and build_topology throw, and LOOP_TURNING.
Work prepare(const Request& request, std::vector<Finding>& findings, const Pins& pins = {}, Work earlier = {});

// The same for cones that are to be placed.
enum class MoreCones { none, some };
struct PlacementRequest {
  const Surface& surface;
  const Cones& existing;  // given angles are kept
  SeamMode seams;
  MoreCones more;
  BorderMode border = BorderMode::free;
};
Work prepare_placement(const PlacementRequest& request, std::vector<Finding>& findings, Work earlier = {});

// The same without positions, which are not accessed.
Work prepare_topology(const Request& request, MoreCones more);

// (m, 3) those of a component's triangles.
Positions directions_on(const Component& component, const Positions& directions);

// Prescribes the turning of a component's boundaries so that a seamless layout follows directions: a sleeve becomes a
// strip. Only if nothing else is prescribed and all boundaries can, with this sum of the cones' curvatures (none:
// free). Returns whether it does.
bool let_borders_run_along(const HalfedgeMesh& mesh, const Positions& directions, int rotation_order,
                           std::optional<double> curvature, ComponentCones& cones);

// Makes a component a strip: of a tube neither boundary turns.
void become_strip(ComponentTask& tube);

// Whether the component is opened along its followed seams because it has no cones.
bool opens_along_seams(const Component& component, const ComponentCones& cones, const Options& options);

// Throws NOT_ORIENTABLE, DEGENERATE_MESH, SCALE_RANGE.
Geometry require_geometry(const Component& component, std::vector<Finding>& findings);

// Renames a component's vertices, triangles or edges into the caller's.
Elements in_source(const Component& component, Elements elements);

// Reports cones without angle on a free boundary.
void report_border_cones(const Component& component, const Array<Index>& border_cones, std::vector<Finding>& findings);

// Appends findings in the caller's numbering.
void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to);

// Why a component has no map, in the caller's numbering.
struct Failure {
  const Component* component;
  Error error;
};
// Puts the message into words for artists. Rethrows CANCELLED.
Failure failure_of(const Component& component, const Error& error);

// Reports failures as COMPONENT_SKIPPED.
void report_skipped(const Array<Failure>& failures, std::vector<Finding>& findings);

// Runs solve(component index) for every component. Errors are reported as COMPONENT_SKIPPED, unless all components
// fail: then the first error is rethrown in the caller's numbering.
template <typename Solve>
void for_each_component(const PerComponent<Component>& components, std::vector<Finding>& findings, Solve solve) {
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

// The same, reporting progress as if all took equally long.
template <typename Solve>
void for_each_component(const PerComponent<Component>& components, std::vector<Finding>& findings,
                        ProgressMonitor& monitor, Solve solve) {
  const double count = static_cast<double>(components.size());
  for_each_component(components, findings, [&](std::size_t i) {
    const double begin = static_cast<double>(i) / count, end = static_cast<double>(i + 1) / count;
    monitor.advance(begin);
    const ProgressMonitor::Interval interval(monitor, begin, end);
    solve(i);
  });
}

}  // namespace lsgp
