// SPDX-License-Identifier: GPL-3.0-or-later
// Cone parameterization with exact affine transitions: the verbs.
//
// Vintescu, Dupont, Lavoue, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG 2017.
// All verbs throw Error and leave their arguments untouched; all are deterministic and safe to call from any thread.
#pragma once

#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
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

// Cones at the extrema of the log scale factor, one after the other (Ben-Chen et al. 2008), `existing` ones first; none
// on a border and, where the mesh has room, none within two rings of another.
// count: cones of every component; negative: as many as bring the predicted L2 stretch near 1.
LSGP_API std::vector<Index> place_cones(const Surface& surface, int count, const std::vector<Index>& existing = {},
                                        SeamMode seams = SeamMode::follow);

// Measures given texture coordinates, (3m, 2); triangles with a NaN are left out.  cones: where a cut may change its
// rotation; none: every vertex whose angles do not add up to a full turn.
LSGP_API Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv,
                                        const std::vector<Index>* cones = nullptr);

}  // namespace lsgp
