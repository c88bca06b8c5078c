// SPDX-License-Identifier: GPL-3.0-or-later
// Where cones may go: single vertices, or vertices together with their images in a mirror plane.
#pragma once

#include <optional>
#include <vector>

#include "curvature.hpp"
#include "lsgp/placement.hpp"

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
std::vector<Index> find_mirror_images(const HalfedgeMesh& mesh, const Geometry& geometry,
                                      const std::optional<MirrorPlane>& plane);

struct ConeSites {
  std::vector<Site> sites;
  int existing = 0;  // the first ones, with cones already
};

// Existing cones, then where others may go: allowed vertices inside, all of them or, to have no more than `most`,
// evenly spread ones and the sharpest of their surroundings.  mirrored: images, or empty.
ConeSites find_cone_sites(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& existing,
                          const std::vector<char>& allowed, const std::vector<Index>& mirrored, int most);

// Marks a vertex and the rings around it.
void mark_rings(const HalfedgeMesh& mesh, Index vertex, int rings, std::vector<char>& marked);

}  // namespace lsgp
