// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Parameterizes one surface again and again, as for a cone that is dragged or an angle that is tried out. Every call
// returns what the verb of the same name does and keeps what the next one may use: the topology and geometry of the
// surface, and, as long as a component's cones stay where they are, its factored linear systems. Angles,
// prescription, unfolding, repair, mode and seamless options may then change without a new factorization.
// A call during another one, from another thread or from its progress callback, throws SOLVER_BUSY.
class LSGP_API Solver {
 public:
  explicit Solver(Surface surface);
  ~Solver();
  Solver(Solver&&) noexcept;

  Result parameterize(const Cones& cones, const Options& options = {}, const Pins& pins = {},
                      const Progress& progress = {});

 private:
  struct Kept;
  Surface surface_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace lsgp
