// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts without a mirror image where cuts are alike on both sides, over all components and reported once.
#pragma once

#include <vector>

#include "mesh/mirror.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

class OneSidedCuts {
 public:
  // Collects them if the component is symmetric and its cones are. Marked seams do not count.
  // mirroring: of the component, or empty.
  void add(const Component& component, const Geometry& geometry, const Mirroring& mirroring, const ComponentMap& map);

  // As CUTS_NOT_MIRRORED.
  void report(std::vector<Finding>& findings) const;

 private:
  Array<Index> edges_;                 // vertex pairs of the caller's
  double one_sided_ = 0, in_all_ = 0;  // lengths of these and of all cuts where they are
};

}  // namespace lsgp
