// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic cones: where to place them and what angle each has.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct MirrorPlane {
  Eigen::Vector3d point, normal;
};

struct PlacementOptions {
  // Cones of every component, existing ones included, fewer where there is no room: then a finding says so. Where their
  // map cannot be used, the error or finding says how many are placed without a number. None: as few as reach the
  // target.
  std::optional<int> count;
  double target = 1.05;               // L2 stretch of the map
  std::optional<Lattice> lattice;     // angles are multiples of its turn, for a seamless layout
  bool prefer_sharp = false;          // sharp corners before smooth places where that costs little
  bool symmetric = false;             // the same cones on both sides of a mirror plane
  std::optional<MirrorPlane> mirror;  // none: found, every component its own
  SeamMode seams = SeamMode::follow;  // a component that gets cones is not opened along its seams
  int threads = 0;                    // as in Options
};

struct Placement {
  std::vector<Index> cones;         // (k) existing ones first, but for those on a border that prescribe nothing
  std::vector<double> cone_angles;  // (k) radians: unwrapping with these gives the map that was measured
  Eigen::VectorXd log_scale;        // (n) predicted, area-weighted mean 0 on every island
  double predicted_l2 = 1;          // over the whole surface, of that log scale
  // The same measured on the map with these cones; infinite where it has flipped triangles or wrong angles, none where
  // it was not made: beyond 60 cones of a component that were asked for by number or marked.
  std::optional<double> mapped_l2;
  bool reached = true;  // the target, on every component: by its map, or as predicted where none was made
  int maps = 0;         // made to find out, of single components
  std::vector<Finding> warnings;
  LinearAlgebra linear_algebra;  // of choosing, without those maps
};

// What one more cone would do, its angle and the automatic ones chosen anew.
struct ConeGains {
  Eigen::VectorXd predicted_l2;  // (n) L2 stretch of the vertex's component with a cone there; NaN where none may be
  double present_l2 = 1;         // over the whole surface as it is; infinite where a component needs a cone
  Index best = -1;               // the vertex that lowers the whole surface's most; -1: none does
  std::vector<Finding> warnings;
};

}  // namespace lsgp
