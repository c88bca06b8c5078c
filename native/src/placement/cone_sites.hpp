// SPDX-License-Identifier: GPL-3.0-or-later
// Where cones may go: single vertices, or vertices together with their images in a mirror plane.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "lsgp/placement.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

// Where a cone may go, or two that mirror each other and share their curvature equally.
struct Site {
  Index vertex;
  Index mirrored = none;
  int cones() const { return mirrored == none ? 1 : 2; }
};

// The vertex at the mirror image of each, (n), none where there is none; empty where the surface is not symmetric, but
// for a few vertices at most.  plane: none: those through the centroid along the axes and the principal directions are
// tried.
Array<Index> find_mirror_images(const HalfedgeMesh& mesh, const Geometry& geometry,
                                const std::optional<MirrorPlane>& plane);

// What cones may be placed on, and where.
struct PlacementTask {
  const HalfedgeMesh& mesh;
  const Geometry& geometry;
  const ComponentCones& existing;
  const Array<char>& allowed;    // (n) vertices that cones may be placed at
  const Array<Index>& mirrored;  // (n) images in a mirror plane, or empty
};

struct ConeSites {
  Array<Site> sites;
  int existing = 0;         // the first ones, with cones already
  bool reaches_all = true;  // no vertex was left out because cuts do not get there
};

// Existing cones, then where others may go: allowed vertices inside that cuts can join, all of them or, to have no more
// than `most`, evenly spread ones and the sharpest of their surroundings.
ConeSites find_cone_sites(const PlacementTask& task, int most);

// Marks a vertex and the rings around it, which end at a vertex of more than 64 triangles.
void mark_rings(const HalfedgeMesh& mesh, Index vertex, int rings, Array<char>& marked);

}  // namespace lsgp
