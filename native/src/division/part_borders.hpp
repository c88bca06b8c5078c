// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a layout and the cuts between them, across which they can be moved together.
#pragma once

#include "base/array.hpp"
#include "division/cut_apart.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// A map divided into parts.
struct MapParts {
  PerHalfedge<char> open;  // between parts, on both sides of an edge
  PerTriangle<Index> part;
  PerPart<Motion> motion;
};

// Open edges along one cut between two parts, and the motion that brings the left one to the right one.
struct PartBorder {
  Index left, right;
  Motion across;
  Array<Index> halfedges;  // of the left part
  double length = 0;
};

// Those of different parts, the longest first.  map: its cuts and transitions.  kept: edges that stay open.
Array<PartBorder> find_part_borders(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept,
                                    const MapParts& parts);

// The larger side of the box around a layout.
double size_of(const Eigen::VectorXcd& corners);

// Whether a motion leaves a layout of this size where it is, up to rounding.
bool is_rest(const Motion& motion, double size);

}  // namespace lsgp
