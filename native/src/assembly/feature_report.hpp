// SPDX-License-Identifier: GPL-3.0-or-later
// Which marked features run along an axis, and why the others do not.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

class MarkedFeatures {
 public:
  // The features of a component in the finished layout.  corners: (3m) positions u + iv.
  void add(const Component& component, const ComponentMap& map, const CornerPositions& corners,
           const Positions& positions);

  // None without features. Names those that were released among the findings.
  std::optional<FeatureReport> report(std::vector<Finding>& findings) const;

 private:
  double length_of(const std::vector<Index>& path) const;

  const Positions* positions_ = nullptr;
  // Of every edge, the lower vertex first, why it is released, if it is on any side: at borders it is in two
  // components.
  std::map<std::pair<Index, Index>, std::optional<ReleaseReason>> edges_;
};

}  // namespace lsgp
