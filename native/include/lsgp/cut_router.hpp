// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts of a finished layout moved by hand, without computing the layout again.
#pragma once

#include <memory>
#include <vector>

#include "lsgp/export.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// A cut on another way between the same ends. The triangles between both ways move rigidly, by a power of the cut's
// transition, the motion that takes the positions on its left side to those on its right side.
struct ReroutedCut {
  std::vector<Index> path;       // (p) vertices from end to end
  std::vector<Index> triangles;  // (t) those that move, ascending
  std::vector<int> powers;       // (t) never 0
  // (2j) pairs of corners, on the left and on the right of where the cut was, that now have one position.
  std::vector<Index> joins;
};

// One cut, or a part of one, that is moved while all others stay. Valid independently of the router it comes from.
class LSGP_API GrabbedCut {
 public:
  GrabbedCut(GrabbedCut&&) noexcept;
  ~GrabbedCut();

  // (2p - 2) corners on both sides of the cut as it was grabbed, edge by edge and from its first vertex to its last.
  const std::vector<Index>& left() const;
  const std::vector<Index>& right() const;

  // The cut by way of a vertex, elsewhere as cheap as the surface's cut costs permit.
  // Throws CUT_NOT_MOVABLE if no such way keeps clear of all other cuts and of nodes and boundaries, or if the layout
  // would have to change between both ways, because a cone, a handle or another cut lies there.
  ReroutedCut through(Index vertex) const;

 private:
  friend class CutRouter;
  struct Kept;
  explicit GrabbedCut(std::unique_ptr<Kept> kept);
  std::unique_ptr<Kept> kept_;
};

// Moves cuts of layouts of one surface; keeps its topology and lengths. Cuts run along the surface's `edges`, and cost
// their lengths times its `cut_costs`; its seams and borders have no meaning here.
class LSGP_API CutRouter {
 public:
  // Throws what `parameterize` throws for invalid surfaces.
  explicit CutRouter(Surface surface);
  ~CutRouter();
  CutRouter(CutRouter&&) noexcept;

  // cuts: (c, 2) the edges of all cuts. path: (p) the vertices of one of them or of a part of it, from end to end; a
  // closed one ends where it begins. nodes: vertices that no cut may be moved across, as cones.
  // Throws EDGE_NOT_IN_MESH, INDEX_OUT_OF_RANGE, CUT_NOT_MOVABLE if the path runs along a boundary, WRONG_PARAMETER.
  GrabbedCut grab(const VertexPairs& cuts, const std::vector<Index>& path, const std::vector<Index>& nodes) const;

 private:
  friend class GrabbedCut;
  struct Kept;
  std::shared_ptr<const Kept> kept_;
};

// The triangles of a layout that overlap others, ascending.  corner_uv: (3m, 2), not finite in those to leave out.
// Throws WRONG_PARAMETER.
LSGP_API std::vector<Index> overlapping_triangles(const CornerUv& corner_uv);

}  // namespace lsgp
