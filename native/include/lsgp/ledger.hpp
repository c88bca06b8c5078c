// SPDX-License-Identifier: GPL-3.0-or-later
// The account of Gauss and Bonnet: the curvature that cones have been given, and what is missing.
#pragma once

#include <array>
#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

// Of one connected part. A flat metric with cones has its curvature at the cones: 2 pi less the cone's angle, on a
// border pi less it. Angles and curvatures in radians.
struct LedgerPart {
  std::vector<Index> triangles;   // (m)
  std::vector<Index> cones;       // (k) places in the caller's list of those that count here
  std::vector<double> curvature;  // (k) NaN where the angle is automatic
  int euler = 0;                  // V - E + F; 0 of a surface with one side, which has no map
  int borders = 0;                // how many
  double assigned = 0;            // the sum of the curvatures given
  double required = 0;            // what all have to add up to
  bool border_takes_up = false;   // a free border takes up what the cones leave
  std::array<double, 2> room{};   // the least and the most that automatic cones can take up together
};

// Of which verbs the parts are: those that parameterize solves one by one, or those that place_cones and cone_gains do.
// They differ where a part without cones is opened along its seams: with its first cone it is whole.
enum class LedgerOf { map, placement };

}  // namespace lsgp
