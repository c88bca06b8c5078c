// SPDX-License-Identifier: GPL-3.0-or-later
// The Gauss-Bonnet budget: the assigned and the missing curvature of cones.
#pragma once

#include <array>
#include <vector>

#include "lsgp/export.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Of one connected component. A flat metric with cones has its curvature at the cones: 2 pi minus the cone's angle, pi
// minus it on a boundary. Angles and curvatures in radians.
struct LedgerPart {
  std::vector<Index> triangles;   // (m)
  std::vector<Index> inside;      // (v) vertices that are not on a boundary
  std::vector<Index> cones;       // (k) indices into the caller's list of those that count here
  std::vector<double> curvature;  // (k) NaN if the angle is automatic
  int euler = 0;                  // V - E + F; 0 for a one-sided surface, which has no map
  int borders = 0;                // number of boundaries
  double assigned = 0;            // the sum of the given curvatures
  double required = 0;            // the sum that all must have
  bool border_takes_up = false;   // a free boundary takes up the remaining curvature
  std::array<double, 2> room{};   // least and most curvature that automatic cones can take up together
};

// Whether angles of the automatic cones exist with which the budget of a component closes.
LSGP_API bool closes(const LedgerPart& part);

// Which components: those that parameterize solves separately, or those of place_cones and cone_gains. They differ if a
// component without cones is opened along its seams: its first cone makes it whole.
enum class LedgerOf { map, placement };

}  // namespace lsgp
