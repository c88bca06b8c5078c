// SPDX-License-Identifier: GPL-3.0-or-later
// One component's way to its map: cut, prescribe, unfold, repair, relax.
#pragma once

#include <optional>
#include <vector>

#include "component_map.hpp"
#include "continuation.hpp"

namespace lsgp {

// Whether defects are to be repaired.
bool repairs(const Options& options);

// What the attempts at a map share.
class Mapping {
 public:
  // repair: counts what the first attempt leaves to repair, and the steps of all.
  Mapping(ComponentSystem& system, const ComponentTask& task, const Options& options, Monitor& monitor,
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

  // Angles that were asked for and have no valid map at once can often be reached from others that have one.  Where
  // they cannot, those nearest to them are taken, but for rounded ones.
  void approach_angles(ComponentMap& map, std::vector<Finding>& findings);

  // The stretch of a valid map lowered.
  void relax(ComponentMap& map);

  // Lets the conformal barrier take out what other weights or another geometry have left in a valid map.
  void smooth(ComponentMap& map);

 private:
  void cut(ComponentMap& map, std::vector<Finding>& findings) const;
  // What decides about a repair; what is returned is checked in the layout.
  void check(ComponentMap& map);
  void repair(const ConnectionChoice& connections, const Connection& connection, const Curvature& target, Effort effort,
              ComponentMap& map);
  // Lets the conformal barrier take out the shear that is left around what was flipped.
  void polish(const Connection& connection, const std::vector<Index>& flipped, ComponentMap& map);
  // Takes the map of the metric's own rotations about handles to the chosen ones; leaves the map as it is where that
  // does not succeed.
  void twist_gradually(const ConnectionChoice& connections, const std::vector<char>& fixed, ComponentMap& map);
  void report_adjusted(const ComponentMap& map, const Continuation& end, std::vector<Finding>& findings) const;
  CutSurface open(const ComponentMap& map) const;
  // Border edges whose direction is imposed.
  std::vector<Index> aligned_edges() const;
  // Vertices a repair has to leave where they are.
  std::vector<char> fixed_vertices(const ComponentMap& map) const;
  // Counts the steps of Newton's method.  Nobody knows how many there will be.
  StepHook counter();

  ComponentSystem& system_;
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const ComponentTask& task_;
  const Options& options_;
  Monitor& monitor_;
  std::optional<RepairReport>& repair_;
};

}  // namespace lsgp
