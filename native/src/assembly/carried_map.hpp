// SPDX-License-Identifier: GPL-3.0-or-later
// The map of a thinned surface on the triangles of the whole one.
#pragma once

#include "lsgp/surface.hpp"
#include "mesh/refined_surface.hpp"
#include "mesh/thinned_surface.hpp"

namespace lsgp {

// Every triangle is mapped as a continuation from where one of its corners is, its home, so that none is torn by a cut
// that crosses it: what is across the cut is moved by the cut's transition. Cuts then run along the edges beside those
// of the thinned surface.
class CarriedMap {
 public:
  // triangles: (m, 3) of the whole surface.  position: of the corners of the refined triangles, not finite where not
  // solved; of those that are replaced it is not read.
  CarriedMap(const Triangles& triangles, const ThinnedSurface& thinned, const RefinedSurface& refined,
             const PerHalfedge<Complex>& position);

  // (3m, 2)
  CornerUv corner_uv() const;
  // Of those triangles: the refined one that determines where it is.
  Index home(Index f) const { return home_[f]; }
  // The edges between differently placed triangles.  twin: of the whole surface.
  VertexPairs cuts(const CornerUv& uv, const PerHalfedge<Index>& twin) const;
  // The linear interpolation of values at the vertices that are left, (n).
  Eigen::VectorXd interpolated(const Eigen::VectorXd& values) const;

 private:
  void mark_cuts();
  void place_vertices();
  Index find_home(Index f) const;
  Index around_added(Index vertex, Index corner) const;
  Complex inside(const SurfacePlace& place) const;
  Complex seen_from(Index home, Index vertex) const;
  Complex seen_around(Index corner, Index home, Index vertex) const;
  Complex across(Index h, Complex z) const;

  const Triangles& triangles_;
  const ThinnedSurface& thinned_;
  const RefinedSurface& refined_;
  const PerHalfedge<Complex>& position_;
  PerVertex<char> is_on_cut_;
  PerTriangle<char> is_beside_cut_;  // of the refined triangles
  PerVertex<char> is_added_;         // to the thinned surface
  PerVertex<Index> around_;          // the refined triangle that each vertex is on
  PerVertex<Complex> of_vertex_;     // its position there
  PerTriangle<Index> home_;
};

}  // namespace lsgp
