// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs flipped triangles, with all transitions fixed.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "prescription/curvature.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/newton.hpp"
#include "systems/distortion_energy.hpp"

namespace lsgp {

enum class Effort {
  local,   // growing neighborhoods of flipped triangles; cones and translations are fixed
  global,  // and if these do not suffice, everything at once, at the cost of some whole unfoldings
};

struct UntangleOptions {
  Effort effort = Effort::local;
  // The energy tried first on neighborhoods: the plain one perturbs an almost valid map less, the framed one stays
  // close to the frames.
  DistortionEnergy::Kind first = DistortionEnergy::Kind::framed_foldover_free;
};

// Moves a map until no triangle is flipped, by Newton's method on the foldover-free energies (Garanzha et al. 2021)
// with rest shapes scaled to the target's metric and rotated by its frames, then smooths the moved region with a
// conformal barrier. The transitions' rotations are fixed, so the seams stay exact. Only the global effort uses the
// connection's reduction. Returns the positions with the fewest defects found.
Eigen::VectorXcd untangle(const CutSurface& surface, const MapTarget& target, const UntangleOptions& options,
                          const StepHook& before_step, const HeldMap& map);

}  // namespace lsgp
