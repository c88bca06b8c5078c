// SPDX-License-Identifier: GPL-3.0-or-later
// Mirror symmetry of surfaces, exact or up to noise and triangulation.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "lsgp/placement.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// A point's mirror image.  plane: with a unit normal.
Eigen::RowVector3d reflected(const MirrorPlane& plane, const Eigen::RowVector3d& at);

// How a surface mirrors itself.
struct Mirroring {
  MirrorPlane plane;       // with a unit normal
  PerVertex<Index> image;  // the vertex at the mirror image of each, or none; empty if the surface is not symmetric

  bool empty() const { return image.empty(); }
};

enum class MirrorSide : char { own, plane, other };

// Of each edge from one side to the other, the end nearer to the plane counts as in it, so that no edge leads past it.
// mirroring: of the mesh, not empty.
PerVertex<MirrorSide> find_mirror_sides(const HalfedgeMesh& mesh, const Mirroring& mirroring);

// The halfedge between the images of a halfedge's ends, or none.
Index mirrored_halfedge(const HalfedgeMesh& mesh, const Mirroring& mirroring, Index h);

// Whether vertices come in pairs, each with one on either side, or lie in the plane; false without a plane.
bool are_mirrored(const Mirroring& mirroring, const Array<Index>& vertices);

// An image's image is the vertex itself.
// plane: if none, those through the centroid along the axes and the principal directions are tried, and fitted to the
// surface where that helps. A plane in which the surface itself lies comes last.
// Either nearly all vertices have an image within a tenth of an edge, or the mirrored surface is within 2 % of the
// surface's extent of itself nearly everywhere: then vertices are paired with those near their images.
Mirroring find_mirror_images(const MetricMesh& surface, const std::optional<MirrorPlane>& plane);

// Components that mirror each other, such as eyes.
struct MirroredComponent {
  Index of = -1;           // an earlier one, or none
  PerVertex<Index> image;  // (n of the earlier one) the vertex at the image of each of its vertices
};

// For each component an earlier one that it mirrors, with an image within a tenth of an edge for every vertex, and that
// mirrors no earlier one.  plane: if none, those of the axes through the origin and the centroid of all.
PerComponent<MirroredComponent> find_mirrored_components(const PerComponent<Component>& components,
                                                         const std::optional<MirrorPlane>& plane);

}  // namespace lsgp
