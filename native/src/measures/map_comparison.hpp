// SPDX-License-Identifier: GPL-3.0-or-later
// What maps whose features run along u and v, or that follow strokes, may cost compared with the usual map.
#pragma once

#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "measures/surface_parts.hpp"

namespace lsgp {

// The mean angle to strokes that is worth another map, radians.
constexpr double least_direction_error = 0.01;

// Flipped and overlapping triangles, and wrong angle sums.
Index defect_count(const Result& result);

// Of triangles that have a map.
Index island_count(const Result& result);

// Whether another map leaves out no further triangles, has no further defects, and up to this L2 stretch.
bool is_as_good(const Result& other, const Result& usual, double most_l2);

// Of the length of marked features, or of creases if none are marked: what runs straight along u or v.
double feature_share(const Result& result);

// Whether a quarter of that length runs there.
bool runs_along_features(const Result& result);

// Whether more than a twentieth of it does not.
bool releases_features(const Result& result);

// The mean angle to the surface's directions, radians; 0 without any.
double direction_error(const Result& result);

// Whether most creases run along the lattice, with this share of them.
bool has_direction(double share);

// The worth of parts of a seamless map with this share of features and this stretch: features along the lattice, little
// stretch, and large tiles everywhere.
double seamless_worth(double share, double l2_stretch, const Result& result);

// The same of the whole map.
double worth_along_features(const Result& result);

// What a seamless layout is worth but for its stretch, as a cost in hundredths of L2 stretch; 0 for other ones.
double cost_on_lattice(const Result& result);

// The same as if all features ran along the lattice.
double least_cost_on_lattice(const Result& result);

// A worth as that cost.
double in_hundredths(double worth);

// The cost as if tiles were as large on all components.
double cost_on_even_lattice(const Result& result);

// Whether an edge of the surface is parallel to u or v, on one of its sides at least.
bool runs_along_axes(const SurfaceParts& parts, const Result& result, Index a, Index b);

// Whether a seamless map through cones for features runs along them, at least as far as the usual one, at up to a tenth
// more of L2 stretch and without further defects.
bool may_replace_for_features(const Result& along, const Result& usual);

// Whether a map that is not seamless has more of its marked features along u and v and is worth more for that, at up to
// a tenth more of L2 stretch and without further islands or defects.
bool may_replace_straighter(const Result& straighter, const Result& usual);

// Whether a map whose angles are chosen for the surface's directions is nearer to them by 0.01 radians or more, at up
// to a tenth more of L2 stretch, and without further islands or defects.
bool follows_strokes_better(const Result& toward, const Result& usual);

// How far features run along the lattice in a usual map.
enum class UsualFeatures { as_far_as_they_can, not_tried };

// On which components the map through cones for features may replace the usual one, by the same measures.
PerComponent<char> gains_features(const SurfaceParts& parts, const Result& along, const Result& usual,
                                  UsualFeatures features);

// Of the stretch that cones are placed for, what is left in a map: half of it by low stretch, measured .25 to .57 on 22
// meshes.
double left_of_stretch(Mode mode);

// The L2 stretch up to which a map reaches a target that is meant for conformal ones, which are judged when cones are
// placed: low stretch may reach it where these do not, and features along the lattice may cost a tenth.
double reached_up_to(double target, const Result& result, Mode mode);

}  // namespace lsgp
