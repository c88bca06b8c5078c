// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

// How the automatic cone angles are chosen.
enum class PrescriptionRule {
  least_distortion,  // minimizes the predicted L2 stretch within bounds
  harmonic,          // log scale zero at the cones (Ben-Chen et al. 2008)
  straightness,      // the paper's section 5
  manual,            // angles as given; cones without one take up the rest with least distortion
};

enum class UnfoldMethod {
  poisson,   // integrates the prescribed metric: one linear solve
  spectral,  // smallest conformal eigenvector (the paper's section 6, Mullen et al. 2008); closed surfaces
};

enum class Method {
  lsgp,  // exact affine transitions across every cut
  // The paper's comparison: the same cuts, two pinned vertices, no transitions (Levy et al. 2002). Not with spectral
  // unfolding, low stretch, straight boundaries, prescribed turning, seamless layouts or pins.
  lscm,
};

// What a map preserves if it cannot preserve both.
enum class Mode {
  conformal,    // angles
  low_stretch,  // lengths, as far as the cone angles permit
};

// The treatment of islands that overlap themselves, as those with cones of negative curvature do.
enum class Overlaps {
  keep,
  split,  // along other cuts for the same cones, then further ones, until no island does; transitions stay exact
};

// Whether islands that would leave much of a square empty are cut further; transitions stay exact. Not in seamless
// layouts; components with pins or marked seams keep their islands.
enum class Compactness {
  off,
  sparing,  // only where a short cut fills much of the square
  full,     // wherever the filled area outweighs the cost of the cut and the additional island
};

// The meaning of a marked seam.
enum class SeamMode {
  follow,    // all seams are cut, other edges if cones and handles need it; components without cones are open there
  exact,     // the seams are cut and nothing else; what cannot be mapped so is refused, overlaps are only reported
  boundary,  // every seam is an open boundary, also of components with cones
  ignore,
};

enum class BorderMode {
  free,      // angles along boundaries are those of least distortion; a cone there with an angle is a corner
  straight,  // boundaries are straight from marked cone to marked cone
  strips,    // a tube between two boundaries, without marks, or open along seams from one to the other, becomes a
             // straight strip if its girth is the same within a tenth all along; other boundaries are free
};

// The lattice of cones and translations in a seamless layout, and its rotations.
enum class Lattice {
  square,       // quarter turns of the unit squares: any tileable texture that looks the same rotated by 90 degrees
  stripe,       // half turns of the unit squares
  translation,  // no rotations, of the unit squares
  triangle,     // third turns of the triangles of side 1
  hexagon,      // sixth turns of the triangles of side 1
};

// The remedy if no layout is valid on a grid as coarse as requested.
enum class CoarseGrid {
  refine,  // use the next finer grid
  merge,   // merge cones less than a cell apart
  relax,   // leave cones off the grid that find no place on it (the paper's section 8)
};

// Where lines of features lie on a lattice.
enum class FeaturePlaces {
  anywhere,  // at whole cells or, where cells are too large for that, at multiples of 1 / 256 of one
  half,      // at half cells or released, at up to a fifth of L2 stretch instead of a tenth
  whole,     // likewise at whole cells
};

// A layout in which a tileable texture shows no seam (the paper's section 8): cone angles are multiples of the
// lattice's rotation, and translations across cuts map lattice points to lattice points.
struct Seamless {
  Lattice lattice = Lattice::square;
  std::optional<double> tiles;      // cells along the layout's longer side, before rounding
  std::optional<double> tile_size;  // or the side of a cell on the surface; neither: the coarsest grid that is valid
                                    // and costs at most a tenth in distortion; small components that need a finer
                                    // one get it for themselves
  bool parity = false;              // square lattice: black and white cells match as well
  FeaturePlaces feature_places = FeaturePlaces::anywhere;
  CoarseGrid coarse_grid = CoarseGrid::refine;
  double cell = 1;  // its side in texture coordinates, a power of two: 1 is a whole tile
};

// How the linear systems of prescription and unfolding are solved; the maps differ only by rounding.
enum class Factorization {
  automatic,  // the cheaper one
  cut,        // one factorization up to the cut, then dense: fast for short cuts
  sparse,     // one for each
};

struct Options {
  PrescriptionRule prescription = PrescriptionRule::least_distortion;
  UnfoldMethod unfold = UnfoldMethod::poisson;
  Method method = Method::lsgp;
  SeamMode seams = SeamMode::follow;
  BorderMode border = BorderMode::free;
  // Total turning of boundary loops, radians, each given by a vertex on it; other loops turn with least distortion.
  std::vector<std::pair<Index, double>> loop_turning;
  std::optional<Seamless> seamless;
  Mode mode = Mode::conformal;
  double stretch = 1;  // with low_stretch: from 0, the conformal map, to 1, the map of least stretch
  // With low_stretch: boundaries and cuts that are nearly straight become exactly straight and axis-aligned, unless
  // that costs noticeable stretch. In seamless layouts on squares, in any mode: those of components without cuts, and
  // creases of hard surfaces run along the lattice.
  bool straighten = false;
  bool repair = true;  // of flipped triangles and angles off by a turn
  // False: only of defects that few vertices around them can mend, which takes little time. Not an option of Python.
  bool hard_repairs = true;
  Overlaps overlaps = Overlaps::keep;
  Compactness compact = Compactness::off;
  // Cuts are alike on both sides of a component's mirror plane, which is detected, if its cones are and that costs
  // little; CUTS_NOT_MIRRORED names those that are not.
  bool mirrored_cuts = false;
  // Automatic cone angles, and rotations about handles in seamless layouts, are chosen for several texture directions
  // that are strokes, on up to half of a component's area, if that makes their mean error smaller by 0.01 radians or
  // more at up to a tenth of L2 stretch.
  bool follow_strokes = true;
  double square_share = 1;  // with compact: number of squares for these islands, above 0: part of one, or UDIM tiles
  Factorization factorization = Factorization::automatic;
  // Number of threads for large factorizations, up to 1024; the result does not depend on it. 0: the value of the
  // environment variable LSGP_THREADS, or else the number of processors.
  int threads = 0;
};

}  // namespace lsgp
