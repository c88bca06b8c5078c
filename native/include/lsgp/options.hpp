// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

// How the automatic cone angles are chosen.
enum class PrescriptionRule {
  least_distortion,  // minimises the predicted L2 stretch within bounds
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
  lscm,  // the paper's comparison: the same cuts, two pinned vertices, no transitions (Levy et al. 2002)
};

// What a marked seam means.
enum class SeamMode {
  follow,    // cuts run along seams wherever they can; seams that close off a part make it an island of its own
  boundary,  // every seam is an open border, as in Blender's own unwrap
  ignore,
};

enum class BorderMode {
  free,      // angles along borders come out as they distort least; a cone there with an angle is a corner
  straight,  // borders run straight from marked cone to marked cone
};

struct Options {
  PrescriptionRule prescription = PrescriptionRule::least_distortion;
  UnfoldMethod unfold = UnfoldMethod::poisson;
  Method method = Method::lsgp;
  SeamMode seams = SeamMode::follow;
  BorderMode border = BorderMode::free;
  // Total turning of boundary loops, radians, each named by a vertex on it; other loops turn as they distort least.
  std::vector<std::pair<Index, double>> loop_turning;
};

}  // namespace lsgp
