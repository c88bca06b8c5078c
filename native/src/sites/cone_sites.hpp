// SPDX-License-Identifier: GPL-3.0-or-later
// Sites of cones: single vertices, or vertices together with their mirror images.
#pragma once

#include <cmath>

#include "base/array.hpp"
#include "lsgp/placement.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

constexpr double sharp_defect = M_PI / 6;  // of an angle

// The site of a cone, or of two that mirror each other and share their curvature equally.
struct Site {
  Index vertex;
  Index mirrored = none;
  int cones() const { return mirrored == none ? 1 : 2; }
};

// The surface and the vertices where cones may be placed.
struct PlacementTask : MetricMesh {
  const ComponentCones& existing;
  const PerVertex<char>& allowed;    // vertices that cones may be placed at
  const PerVertex<Index>& mirrored;  // images in a mirror plane, or empty
};

struct ConeSites {
  Array<Site> sites;
  int existing = 0;         // the first ones, with cones already
  bool reaches_all = true;  // no vertex was left out because cuts cannot reach it
};

// Existing cones, then the sites of others: allowed interior vertices that cuts can reach, all of them or, if there are
// more than `most`, evenly distributed ones, each the sharpest of its neighborhood.
ConeSites find_cone_sites(const PlacementTask& task, int most);

// A vertex and those in the rings around it, which end at a vertex of more than 64 triangles, in ascending order.
Array<Index> rings_around(const HalfedgeMesh& mesh, Index vertex, int rings);
void mark_rings(const HalfedgeMesh& mesh, Index vertex, int rings, PerVertex<char>& marked);

}  // namespace lsgp
