// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Parameterizes one surface repeatedly, for instance while a cone is dragged or an angle is tried, or once cones are
// placed. Every call returns the same as the function of that name and caches data for the next one: the topology and
// geometry of the surface, and, as long as a component's cones do not move, its factored linear systems, also those of
// placed cones. Angles, prescription, unfolding, repair, mode and seamless options can then change without a new
// factorization. A seamless layout that differs from the previous one only in the size of its tiles takes only their
// rounding: the map, and which creases run along the lattice, are kept.
// A call during another one, from another thread or from its progress callback, throws SOLVER_BUSY.
class LSGP_API Solver {
 public:
  explicit Solver(Surface surface);
  // What the earlier one, or those it has it from, found on components that are the same on this surface, as where only
  // other borders differ, is used here, and the other way round. Both are busy during a call of either.
  Solver(Surface surface, const Solver& earlier);
  ~Solver();
  Solver(Solver&&) noexcept;

  const Surface& surface() const { return surface_; }

  Result parameterize(const Cones& cones, const Options& options = {}, const Pins& pins = {},
                      const Progress& progress = {});
  Placement place_cones(const Cones& existing = {}, const PlacementOptions& options = {},
                        const Progress& progress = {});

 private:
  struct Kept;
  Surface surface_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace lsgp
