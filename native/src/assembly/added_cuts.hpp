// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts besides the marked seams, counted over all components and reported once.
#pragma once

#include <vector>

#include "pipeline/component_map.hpp"

namespace lsgp {

class AddedCuts {
 public:
  // Collects them if a component has marked seams. Edges that are no longer cuts and cuts that split overlaps do not
  // count.
  void add(const Component& component, const ComponentMap& map);

  // As CUTS_ADDED.
  void report(std::vector<Finding>& findings) const;

 private:
  Array<Index> edges_;  // vertex pairs of the caller's
  bool open_handles_ = false, reach_cones_ = false, open_holes_ = false;
};

}  // namespace lsgp
