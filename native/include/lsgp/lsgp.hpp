// SPDX-License-Identifier: GPL-3.0-or-later
// Cone parameterization with exact affine transitions: the verbs.
//
// Vintescu, Dupont, Lavoue, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG 2017.
// All verbs throw Error and leave their arguments untouched; all are deterministic and safe to call from any thread.
#pragma once

#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/solver.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Cuts every component through its cones and unfolds it (the paper's section 3.2).
// A component that cannot be solved is reported as a finding when another one could, thrown otherwise.
// pins: with two or more on a component its map goes through them, and its place, size and turn are theirs; with one,
// its place is.
// progress: may be empty.
LSGP_API Result parameterize(const Surface& surface, const Cones& cones, const Options& options = {},
                             const Pins& pins = {}, const Progress& progress = {});

// The cuts alone (section 4.1): shortest paths that join cones and boundary loops and open every handle.  A map needs
// fewer where the metric turns exactly once about a hole, which only its prescription tells.
LSGP_API CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options = {});

// The cone angles alone (section 5) and the scale they imply.
LSGP_API Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options = {});

// Completes existing cones, whose given angles stay, to as many as asked for or as few as reach the target; none is
// placed on a border.  A component without a solution is reported as a finding when another one has one, thrown
// otherwise; a target that is not reached is a finding.
LSGP_API Placement place_cones(const Surface& surface, const Cones& existing = {}, const PlacementOptions& options = {},
                               const Progress& progress = {});

// What one more cone would do to the stretch, wherever it is placed.
LSGP_API ConeGains cone_gains(const Surface& surface, const Cones& existing = {}, SeamMode seams = SeamMode::follow,
                              const Progress& progress = {});

// Measures given texture coordinates, (3m, 2); triangles with a NaN are left out.  cones: where a cut may change its
// rotation; none: every vertex whose angles do not add up to a full turn.
LSGP_API Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv,
                                        const std::vector<Index>* cones = nullptr);

}  // namespace lsgp
