// SPDX-License-Identifier: GPL-3.0-or-later
// Islands that are alike on both sides of a mirror plane.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "cut/cut_graph.hpp"
#include "division/part_borders.hpp"
#include "mesh/mirror.hpp"
#include "mesh/point_tree.hpp"

namespace lsgp {

// Finds cuts that differ on the two sides of a mirror plane, and makes layouts in which none do.
class MirroredIslands {
 public:
  // mirroring: of the mesh, not empty.
  MirroredIslands(const MetricMesh& surface, Borrowed<const Mirroring> mirroring);

  // Length of the open edges with no open edge within a mean edge of their mirror image, or of the vertex nearest to it
  // where the image lies off the surface. Those in the plane have one.
  double one_sided_length(const PerHalfedge<char>& open) const;

  // These edges, one halfedge of each.
  Array<Index> one_sided_edges(const PerHalfedge<char>& open) const;

  // Opens the map where `open` is on one side, and at the mirror image of that. Its other cuts are closed, the most
  // expensive first, as far as the cones allow: what is left of them is on one side alone. Islands may overlap
  // themselves then.
  // map: with transitions, without seams.  open: on both halfedges, with all cones on it.  side: not `plane`.
  MapParts along_side(const ComponentMap& map, const PerHalfedge<char>& open, MirrorSide side) const;

  // The same for either side.
  MapParts along_both(const ComponentMap& map, const PerHalfedge<char>& open) const;

  // The same after cuts of one side that start and end on the plane are rerouted along it, since they would enclose a
  // piece together with their images; none without such cuts.
  std::optional<MapParts> along_plane(const ComponentMap& map, const PerHalfedge<char>& open) const;

 private:
  Array<Index> one_sided_halves(const PerHalfedge<char>& open) const;
  bool is_in_plane(Index h) const;
  bool is_on(Index h, MirrorSide side) const;
  Index image_near(Index v) const;
  Array<Index> image_of(const Array<Index>& path) const;
  Array<Cut> paths_of(PerHalfedge<char> edges, const Array<Index>& cones) const;
  Array<Index> in_plane(const Cut& path) const;
  PerHalfedge<char> with_images(const PerHalfedge<char>& open, const Array<Index>& cones, MirrorSide side) const;
  MapParts along(const ComponentMap& map, const PerHalfedge<char>& wanted) const;
  void join(const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts) const;

  const MetricMesh surface_;
  const Mirroring& mirroring_;
  const PerVertex<MirrorSide> side_;
  const PointTree vertices_;
  const double edge_;  // mean length
};

}  // namespace lsgp
