// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs and improves the map of a component; every step ends with a check of the map.
#pragma once

#include <optional>
#include <vector>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "repair/continuation.hpp"

namespace lsgp {

// The metrics of two angles at the same cones.
struct MetricChange {
  const Curvature &begin, &end;
};

class ComponentRepair {
 public:
  // report: gets the steps of Newton's method; it has to exist where there are any.
  ComponentRepair(ComponentSystem& system, const ComponentTask& task, const Options& options, ProgressMonitor& monitor,
                  std::optional<RepairReport>& report)
      : system_(system),
        mesh_(system.mesh()),
        geometry_(system.geometry()),
        task_(task),
        options_(options),
        monitor_(monitor),
        report_(report) {}

  // Finds the defects that decide about a repair; the final result is checked in the layout.
  void check(ComponentMap& map);

  // Removes flips and wrong angle sums as far as the effort goes.  connection: of the map, among `connections`.
  // target: the metric, in the scale of the map.
  void repair(const ParallelTransportChoice& connections, const ParallelTransport& connection, const Curvature& target,
              Effort effort, ComponentMap& map);

  // Removes the residual shear around formerly flipped triangles with the conformal barrier energy.
  void polish(const ParallelTransport& connection, const Array<Index>& flipped, ComponentMap& map);

  // Smooths the map with the conformal barrier energy after a fit with other weights or another metric.
  void smooth(ComponentMap& map);

  // Replaces the map by one continued from a valid map with the same holes closed, toward its own angles, with the
  // cuts of that map. If they cannot be reached, takes the nearest angles reached and reports that; rounded angles are
  // never changed.  metric: of this surface; either map may be of other triangles. Returns how far it came, 1 being all
  // the way.
  double continue_from(ComponentMap start, const MetricChange& metric, ComponentMap& map,
                       std::vector<Finding>& findings);

  // Lowers the stretch of a valid map.
  void relax(ComponentMap& map);

  // Whether the options and the map admit straightening its boundary.
  bool may_straighten(const ComponentMap& map) const;

  // The map with the nearly straight sides of its boundary straight and along the axes; none if no attempt stays within
  // its bounds or if there is nothing to straighten.
  std::optional<ComponentMap> straightened(const ComponentMap& map);

  // Counts the steps of Newton's method, the number of which is not known in advance.
  StepHook counter();

 private:
  // Continues the map from the metric's own rotations about handles to the chosen ones; leaves the map unchanged on
  // failure.
  void twist_gradually(const ParallelTransportChoice& connections, const PerVertex<char>& fixed, ComponentMap& map);
  void report_adjusted(const ComponentMap& map, const Continuation& end, std::vector<Finding>& findings) const;
  CutSurface open(const ComponentMap& map) const;
  std::optional<ComponentMap> straightened_as_strip(const CutSurface& surface, const ComponentMap& map);
  // The connection that a valid map realizes: the metric's if its rotations match, but rotations about handles may be
  // those of another geometry.
  ParallelTransport connection_of(const ComponentMap& map) const;
  // Vertices that a repair must not move.
  PerVertex<char> fixed_vertices(const ComponentMap& map) const;

  ComponentSystem& system_;
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const ComponentTask& task_;
  const Options& options_;
  ProgressMonitor& monitor_;
  std::optional<RepairReport>& report_;
};

}  // namespace lsgp
