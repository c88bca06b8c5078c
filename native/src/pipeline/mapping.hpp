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

// What the attempts at a map share.
class Mapping {
 public:
  // repair: counts what the first attempt leaves to repair, and the steps of all.
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

  // Angles that were asked for and have no valid map at once can often be reached from others that have one. Where
  // they cannot, those nearest to them are taken, but for rounded ones.
  void approach_angles(ComponentMap& map, std::vector<Finding>& findings);

  // The stretch of a valid map lowered.
  void relax(ComponentMap& map);

  // Lets the conformal barrier take out what other weights or another geometry have left in a valid map.
  void smooth(ComponentMap& map);

 private:
  void cut(ComponentMap& map) const;
  // What decides about a repair; what is returned is checked in the layout.
  void check(ComponentMap& map);
  void repair(const ParallelTransportChoice& connections, const ParallelTransport& connection, const Curvature& target,
              Effort effort, ComponentMap& map);
  // Lets the conformal barrier take out the shear that is left around what was flipped.
  void polish(const ParallelTransport& connection, const Array<Index>& flipped, ComponentMap& map);
  // Takes the map of the metric's own rotations about handles to the chosen ones; leaves the map as it is where that
  // does not succeed.
  void twist_gradually(const ParallelTransportChoice& connections, const Array<char>& fixed, ComponentMap& map);
  void report_adjusted(const ComponentMap& map, const Continuation& end, std::vector<Finding>& findings) const;
  CutSurface open(const ComponentMap& map) const;
  // The connection that a valid map realises: the metric's where its rotations are those, but about handles they may be
  // those of another geometry.
  ParallelTransport connection_of(const ComponentMap& map) const;
  // Border edges whose direction is imposed.
  Array<Index> aligned_edges() const;
  // Vertices a repair has to leave where they are.
  Array<char> fixed_vertices(const ComponentMap& map) const;
  // Counts the steps of Newton's method. Nobody knows how many there will be.
  StepHook counter();

  ComponentSystem& system_;
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const ComponentTask& task_;
  const Options& options_;
  ProgressMonitor& monitor_;
  std::optional<RepairReport>& repair_;
};

}  // namespace lsgp
