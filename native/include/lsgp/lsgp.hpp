// SPDX-License-Identifier: GPL-3.0-or-later
// Cone parameterization with exact affine transitions: the verbs.
//
// Vintescu, Dupont, Lavoue, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG 2017.
// All verbs throw Error and leave their arguments untouched; all are deterministic and safe to call from any thread.
#pragma once

#include "lsgp/crease_borders.hpp"
#include "lsgp/cut_costs.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/ledger.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/quads.hpp"
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

// The cuts alone (section 4.1): paths that join cones and boundary loops and open every handle, as short as a local
// search finds them, or as cheap where the surface has costs of cuts. A map needs fewer where the metric turns exactly
// once about a hole, which only its prescription tells.
LSGP_API CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options = {},
                            const Progress& progress = {});

// What a cut along each of the surface's `edges` should cost, (e), for `Surface::cut_costs`: little where it is hidden,
// runs along a crease or is wanted. WRONG_PARAMETER without edges, or with preferences that are none.
LSGP_API Eigen::VectorXd cut_costs(const Surface& surface, const CutPreferences& preferences,
                                   const Progress& progress = {});

// Edges for `Surface::borders`, so that hard surfaces unfold with hardly any stretch and without cones: their creases,
// as far as parts cannot be unfolded together across them, and one edge path along every tube. Components with cones or
// seams have none, nor have those whose curvature lies off their creases. WRONG_PARAMETER.
LSGP_API VertexPairs crease_borders(const Surface& surface, const std::vector<Index>& cones = {},
                                    const CreaseOptions& options = {}, const Progress& progress = {});

// The cone angles alone (section 5) and the scale they imply.
LSGP_API Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options = {},
                                          const Progress& progress = {});

// The account of every connected part, in the order of their first triangles. Positions are not looked at, and of the
// cones only that they are vertices; the options' prescription, seams and border count.
LSGP_API std::vector<LedgerPart> build_ledger(const Surface& surface, const Cones& cones, const Options& options = {},
                                              LedgerOf of = LedgerOf::map);

// Completes existing cones, whose given angles stay, to as many as asked for or as few as reach the target; none is
// placed on a border, or where no edges lead that cuts may follow. A component without a solution is reported as a
// finding when another one has one, thrown otherwise; a target that is not reached is a finding.
LSGP_API Placement place_cones(const Surface& surface, const Cones& existing = {}, const PlacementOptions& options = {},
                               const Progress& progress = {});

// What one more cone would do to the stretch, wherever it is placed.
LSGP_API ConeGains cone_gains(const Surface& surface, const Cones& existing = {}, SeamMode seams = SeamMode::follow,
                              const Progress& progress = {});

// Measures given texture coordinates, (3m, 2), otherwise WRONG_PARAMETER; triangles with one that is not finite are
// left out.  cones: where a cut may change its rotation; none: every vertex whose angles do not add up to a full turn.
LSGP_API Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv,
                                        const std::vector<Index>* cones = nullptr, const Progress& progress = {});

}  // namespace lsgp
