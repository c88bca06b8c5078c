// SPDX-License-Identifier: GPL-3.0-or-later
// Cone parameterization with exact affine transitions: the functions.
//
// Vintescu, Dupont, Lavoue, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG 2017.
// All functions throw Error and do not modify their arguments; all are deterministic and safe to call from any thread.
#pragma once

#include "lsgp/auto_unwrap.hpp"
#include "lsgp/completed_cones.hpp"
#include "lsgp/crease_borders.hpp"
#include "lsgp/cut_costs.hpp"
#include "lsgp/cut_router.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/ledger.hpp"
#include "lsgp/options.hpp"
#include "lsgp/packing.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/preview.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/quads.hpp"
#include "lsgp/result.hpp"
#include "lsgp/shaping.hpp"
#include "lsgp/solver.hpp"
#include "lsgp/surface.hpp"
#include "lsgp/tubes.hpp"

namespace lsgp {

// Cuts every component through its cones and unfolds it (the paper's section 3.2).
// A component that cannot be solved is reported as a finding if another one can; otherwise its error is thrown.
// pins: two or more on a component determine its position, size and rotation, and its map meets all of them; one
// determines its position.
// progress: may be empty.
LSGP_API Result parameterize(const Surface& surface, const Cones& cones, const Options& options = {},
                             const Pins& pins = {}, const Progress& progress = {});

// The cuts alone (section 4.1): paths that join cones and boundary loops and open every handle, as short as a local
// search finds them; if the surface has cut costs, as cheap. A map needs fewer if the metric turns exactly once about a
// hole, which only its prescription determines.
LSGP_API CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options = {},
                            const Progress& progress = {});

// The charts that the surface's marked seams bound, each with what its map without cones and further cuts is worth: a
// map made with SeamMode::exact and otherwise these options.
LSGP_API std::vector<Chart> measure_charts(const Surface& surface, const Options& options = {},
                                           const Progress& progress = {});

// Vertex chains between nodes: the given ones and every vertex where not exactly two of the edges meet. A loop without
// a node begins and ends at its lowest vertex. The same for any order of the edges; those given twice count once.
LSGP_API std::vector<std::vector<Index>> split_into_paths(const VertexPairs& edges, const std::vector<Index>& nodes);

// The cost per length of a cut along each of the surface's `edges`, (e), for `Surface::cut_costs`: low if it is hidden,
// along a crease or attracted by paint. WRONG_PARAMETER without edges, or with invalid preferences.
LSGP_API Eigen::VectorXd cut_costs(const Surface& surface, const CutPreferences& preferences,
                                   const Progress& progress = {});

// Edges for `Surface::borders` that enclose the parts where cuts are dear, ten times as much as usual and more, as in
// front, and divide them from those where they cost no more than usual. None where cuts have no costs, or where these
// differ too little. Throws what `parameterize` throws for surfaces.
LSGP_API VertexPairs costly_outline(const Surface& surface, const Progress& progress = {});

// Edges for `Surface::borders`, so that hard surfaces unfold with hardly any stretch and without cones: their creases,
// unless patches can be unfolded together across them, and one edge path along every tube. Components with cones or
// seams have none, nor have those with curvature off their creases. WRONG_PARAMETER.
LSGP_API VertexPairs crease_borders(const Surface& surface, const std::vector<Index>& cones = {},
                                    const CreaseOptions& options = {}, const Progress& progress = {});

// The same by each of several options; what they have in common is found once.
LSGP_API std::vector<VertexPairs> crease_borders_by(const Surface& surface, const std::vector<Index>& cones,
                                                    const std::vector<CreaseOptions>& options,
                                                    const Progress& progress = {});

// The tubes of components that consist of them for the most part, and handles of others: between their borders they
// unfold into strips with `BorderMode::strips`. Handles and what is closed on itself, as a knot is, are tubes only if
// strips of them would be stretched by no more than `Tubes::most_l2`, and closed ones only of even girth; components of
// 30,000 triangles or more are not searched for handles. A quad is two triangles on both sides of an edge that is not
// among `Surface::edges`; where these are all, on both sides of the longest edge of both. Components with cones or
// seams have none, but for tubes that seams open from one end to the other.
LSGP_API Tubes find_tubes(const Surface& surface, const std::vector<Index>& cones = {}, const Progress& progress = {});

// Cones, with angles, with which features and, if asked for, creases of closed hard surfaces can run along the lines of
// a square lattice: at their corners, and inside the patches between them as far as Gauss-Bonnet requires. None on
// components with boundaries that are no features, or where the patches admit none.
LSGP_API Cones feature_cones(const Surface& surface, bool with_creases = true, const Progress& progress = {});

// The cone angles alone (section 5) and the scale they imply.
LSGP_API Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options = {},
                                          const Progress& progress = {});

// The budget of every connected component, in the order of their first triangles. Positions are not used, and cones
// only have to be vertices; of the options, prescription, seams and border have an effect.
LSGP_API std::vector<LedgerPart> build_ledger(const Surface& surface, const Cones& cones, const Options& options = {},
                                              LedgerOf of = LedgerOf::map);

// Completes existing cones, with their given angles, to the requested number or the fewest that reach the target; none
// is placed on a boundary, or where cuts cannot reach it. A component without a solution is reported as a finding if
// another one has one, otherwise its error is thrown; a missed target is a finding.
LSGP_API Placement place_cones(const Surface& surface, const Cones& existing = {}, const PlacementOptions& options = {},
                               const Progress& progress = {});

// The effect of one more cone on the stretch, for every vertex.
LSGP_API ConeGains cone_gains(const Surface& surface, const Cones& existing = {}, SeamMode seams = SeamMode::follow,
                              const Progress& progress = {});

// Measures given texture coordinates, (3m, 2), otherwise WRONG_PARAMETER; triangles with a coordinate that is not
// finite are left out.  cones: where a cut may change its rotation; none: every vertex whose angles do not add up to a
// full turn.
LSGP_API Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv,
                                        const std::vector<Index>* cones = nullptr, const Progress& progress = {});

}  // namespace lsgp
