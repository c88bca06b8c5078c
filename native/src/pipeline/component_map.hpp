// SPDX-License-Identifier: GPL-3.0-or-later
// The map of one component with what it imposes, and its checks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "cut/cut_graph.hpp"
#include "cut/cut_mesh.hpp"
#include "pipeline/components.hpp"
#include "prescription/component_system.hpp"
#include "unfold/distortion.hpp"
#include "unfold/pins.hpp"

namespace lsgp {

// A component's map and its constraints, in its own numbering.
struct ComponentMap {
  CutGraph cut_graph;
  CutMesh cut_mesh;
  Array<Index> required_cuts;        // halfedges, one of each edge that is cut before overlaps are split
  bool has_straight_cuts = false;    // cone angles were chosen for straight cuts
  Holes holes = Holes::where_cheap;  // those that were to close
  Curvature curvature;
  Array<Index> cones;                       // interior
  Array<Index> flat_cones;                  // cones rounded to zero curvature
  std::optional<Eigen::VectorXd> rotation;  // (cuts) imposed, radians; none without transitions
  Eigen::VectorXcd position;                // (copies) u + iv
  Array<Pin> pins;
  double natural_l2 = 0;                       // before sides were straightened; 0 if none may be
  double uv_area = 0;                          // signed
  PerHalfedge<ReleaseReason> release_reasons;  // of features off the axes; empty: with these options none is aligned
  SeamQuality seams;
  Array<Index> inexact_seams;  // halfedges
  Validity validity;
  RepairReport repair;
};

// A map and what was found about it.
struct FoundMap {
  ComponentMap map;
  std::vector<Finding> findings;

  std::size_t defects() const { return map.validity.defects(); }
};

// A map after its islands were divided for a square of that area, as far as `compact` says, and their sides
// straightened.
struct DividedMap {
  ComponentMap map;
  Compactness compact;
  double square_area;
};

// Measure positions u + iv at the component's corners, (3m), against what the map imposed.
void check_seams(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map);
void check_triangles(const HalfedgeMesh& mesh, const CornerPositions& corners, ComponentMap& map);

// Measures the map's own positions in this way, and their area. Throws SOLVER_FAILED if some are not finite.
void check_positions(const HalfedgeMesh& mesh, ComponentMap& map);

// A layout with its parts moved apart.  position: (3m) u + iv at the corners.
Eigen::VectorXcd side_by_side(const PerTriangle<Index>& part, Eigen::VectorXcd position);

// Whether a part of a layout without flipped triangles overlaps itself.  position, twin: as for has_overlap.
bool has_overlap_within(const PerTriangle<Index>& part, Eigen::VectorXcd position, const PerHalfedge<Index>& twin);

}  // namespace lsgp
