// SPDX-License-Identifier: GPL-3.0-or-later
// Computes the map of one component: cut, prescribe, unfold, repair, relax.
#pragma once

#include <optional>
#include <vector>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "repair/continuation.hpp"

namespace lsgp {

// Whether defects are to be repaired.
bool repairs(const Options& options);

// State shared by the attempts at a map.
class Mapping {
 public:
  // repair: counts the defects of the first attempt, and the steps of all attempts.
  Mapping(ComponentSystem& system, const ComponentTask& task, const Options& options, ProgressMonitor& monitor,
          std::optional<RepairReport>& repair)
      : system_(system),
        mesh_(system.mesh()),
        geometry_(system.geometry()),
        task_(task),
        options_(options),
        monitor_(monitor),
        repair_(repair) {}

  // The map with these cones, repaired as far as the effort goes.
  ComponentMap attempt(const ComponentCones& cones, Effort effort, std::vector<Finding>& findings);

  // Prescribed angles for which no valid map is found directly can often be reached by continuation from angles that
  // have one. If they cannot, takes the nearest angles reached; rounded angles are never changed.
  void approach_angles(ComponentMap& map, std::vector<Finding>& findings);

  // Lowers the stretch of a valid map.
  void relax(ComponentMap& map);

  // Straightens the nearly straight sides of the outline of a valid map of low stretch and aligns them with the axes;
  // leaves the map unchanged if that costs noticeable stretch.
  void straighten(ComponentMap& map);

  // Smooths the map with the conformal barrier energy after a fit with other weights or another metric.
  void smooth(ComponentMap& map);

 private:
  void cut(ComponentMap& map) const;
  // Finds the defects that decide about a repair; the final result is checked in the layout.
  void check(ComponentMap& map);
  void repair(const ParallelTransportChoice& connections, const ParallelTransport& connection, const Curvature& target,
              Effort effort, ComponentMap& map);
  // Removes the residual shear around formerly flipped triangles with the conformal barrier energy.
  void polish(const ParallelTransport& connection, const Array<Index>& flipped, ComponentMap& map);
  // Continues the map from the metric's own rotations about handles to the chosen ones; leaves the map unchanged on
  // failure.
  void twist_gradually(const ParallelTransportChoice& connections, const PerVertex<char>& fixed, ComponentMap& map);
  void report_adjusted(const ComponentMap& map, const Continuation& end, std::vector<Finding>& findings) const;
  CutSurface open(const ComponentMap& map) const;
  // The connection that a valid map realises: the metric's if its rotations match, but rotations about handles may be
  // those of another geometry.
  ParallelTransport connection_of(const ComponentMap& map) const;
  // Boundary edges with an imposed direction.
  Array<Index> aligned_edges() const;
  // Vertices that a repair must not move.
  PerVertex<char> fixed_vertices(const ComponentMap& map) const;
  // Counts the steps of Newton's method, the number of which is not known in advance.
  StepHook counter();
  bool may_straighten(const ComponentMap& map) const;
  // None if no attempt stays within its bounds or if there is nothing to straighten.
  std::optional<ComponentMap> straightened(const ComponentMap& map);
  // The map of low stretch whose boundaries turn by multiples of a quarter turn, if they nearly do; none if they
  // already do or if they are far from it.
  std::optional<ComponentMap> with_quarter_turns(const ComponentMap& map);

  ComponentSystem& system_;
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const ComponentTask& task_;
  const Options& options_;
  ProgressMonitor& monitor_;
  std::optional<RepairReport>& repair_;
};

}  // namespace lsgp
