// SPDX-License-Identifier: GPL-3.0-or-later
// What calls found on one component, for later ones with the same input, also of surfaces with other borders that leave
// the component as it is.
#pragma once

#include <optional>
#include <vector>

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "mesh/mirror.hpp"
#include "mesh/topology.hpp"
#include "pipeline/component_map.hpp"
#include "pipeline/components.hpp"
#include "placement/component_placement.hpp"
#include "seamless/feature_alignment.hpp"

namespace lsgp {

struct MapResult {
  std::optional<FoundMap> map;                // before it is put onto a lattice, or after overlaps are split; none yet
  std::optional<DividedMap> divided;          // after that; none yet
  std::optional<FeatureAlignment> alignment;  // of a seamless layout
};

// What determines the cones that are placed on a component.
struct PlacementInput {
  ComponentCones existing;
  PerVertex<char> allowed;
  PerVertex<Index> mirrored;
  Positions directions;  // (m, 3) of the component's triangles, or empty
  PlacementOptions options;
};

struct PlacementResult {
  ConePlacement placed;
  std::vector<Finding> found;
};

class ComponentResults {
 public:
  // Of a map of the task's cones with these options, without pins: what was found for it, or for one that is the same
  // before its size, its lattice's lines or its square are chosen. The latest few are kept.
  MapResult& of_map(const ComponentTask& task, const Options& options);

  const PlacementResult* find_placement(const PlacementInput& input) const;  // null if there is none
  void keep_placement(PlacementInput input, PlacementResult result);

  std::optional<Mirroring> mirroring;  // once it was requested

 private:
  struct OfMap {
    ComponentTask task;
    Options options;
    MapResult result;
  };
  struct OfPlacement {
    PlacementInput input;
    PlacementResult result;
  };

  Array<OfMap> maps_;
  Array<OfPlacement> placements_;
};

// Whether components are the same, vertices and triangles having the same numbers on their surfaces as well.
bool is_same(const Component& a, const Component& b);

}  // namespace lsgp
