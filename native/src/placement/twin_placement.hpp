// SPDX-License-Identifier: GPL-3.0-or-later
// The same cones on components that mirror each other.
#pragma once

#include <optional>
#include <vector>

#include "base/borrowed.hpp"
#include "mesh/mirror.hpp"
#include "placement/component_placement.hpp"

namespace lsgp {

// Components are placed in order; one that mirrors an earlier one gets the images of its cones, with the same angles,
// if their map is as good.
class TwinPlacement {
 public:
  // Without symmetry, no component has a twin.
  TwinPlacement(Borrowed<const PerComponent<Component>> components, PlacementOptions options,
                const std::optional<MirrorPlane>& plane);

  // The images of the cones of the component's twin; none if it has none, if either has cones already, or if their map
  // is not as good.
  std::optional<PlacedCones> place(const Component& component, const PlacementTask& task, ProgressMonitor& monitor);

  // Whether it mirrors another one.
  bool is_mirrored(const Component& component) const;

  // For later twins.  task: without cones, or they are not repeated.
  void keep(const Component& component, const PlacementTask& task, const PlacedCones& placed);

 private:
  struct Kept {
    ComponentCones cones;
    double l2 = 0;
  };

  std::ptrdiff_t number(const Component& component) const { return &component - components_.data(); }

  const PerComponent<Component>& components_;
  const PlacementOptions options_;
  PerComponent<MirroredComponent> twins_;
  PerComponent<std::optional<Kept>> kept_;
};

}  // namespace lsgp
