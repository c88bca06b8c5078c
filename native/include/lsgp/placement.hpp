// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic cones: their positions and angles.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/linear_algebra.hpp"
#include "lsgp/options.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct MirrorPlane {
  Eigen::Vector3d point, normal;
};

struct PlacementOptions {
  // Cones of every component, including existing ones; fewer if there is no room, which a finding reports. If their map
  // is unusable, the error or finding says how many are placed without a number. None: the fewest that reach the
  // target.
  std::optional<int> count;
  // Without `count`: placement on a component stops once it has more cones than this, given ones included, and misses
  // the target. Then it has no map, and a finding says so.
  std::optional<int> most;
  double target = 1.05;                  // L2 stretch of the map
  std::optional<Lattice> lattice;        // angles are multiples of its rotation, for a seamless layout
  bool prefer_sharp = false;             // prefer sharp corners to smooth regions if that costs little
  bool symmetric = false;                // the same cones on both sides of a mirror plane
  std::optional<MirrorPlane> mirror;     // none: detected for every component
  bool follow_strokes = true;            // as in Options
  SeamMode seams = SeamMode::follow;     // a component that gets cones is not opened along its seams
  BorderMode border = BorderMode::free;  // strips: tubes between two boundaries get no cones
  // Cones of a noisy surface, as a scan, are chosen on its shape: noise at the scale of triangles has no part in it.
  // Log scale, stretch and target are that shape's, while a map of the surface has the stretch of noise besides.
  bool without_noise = false;
  // As in Options, of the maps with cones that are tried. False: nor are smaller and larger numbers of cones tried
  // where these have defects or much stretch.
  bool hard_repairs = true;
  int threads = 0;  // as in Options
};

struct Placement {
  std::vector<Index> cones;         // (k) existing ones first, without those on a boundary that have no angle
  std::vector<double> cone_angles;  // (k) radians: unwrapping with these gives the map that was measured
  Eigen::VectorXd log_scale;        // (n) predicted, area-weighted mean 0 on every island
  double predicted_l2 = 1;          // over the whole surface, of that log scale
  // The same measured on the map with these cones; infinite if it has flipped triangles or wrong angles.
  double mapped_l2 = 1;
  bool reached = true;  // the target, by the map of every component
  int maps = 0;         // number of trial maps of components
  std::vector<Finding> warnings;
  LinearAlgebra linear_algebra;  // of the choice, without those maps
};

// The effect of one more cone, with its angle and the automatic ones recomputed.
struct ConeGains {
  Eigen::VectorXd predicted_l2;  // (n) L2 stretch of the vertex's component with a cone there; NaN where none may be
  double present_l2 = 1;         // over the whole surface with the given cones; infinite if a component needs a cone
  // The vertex that lowers the whole surface's most; -1: none does. If the surface has cut_costs, cuts may reach
  // another one more cheaply that lowers it at least half as much.
  Index best = -1;
  std::vector<Finding> warnings;
};

}  // namespace lsgp
