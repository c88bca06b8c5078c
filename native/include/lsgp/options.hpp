// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

struct Options {
  PrescriptionRule prescription = PrescriptionRule::least_distortion;
  UnfoldMethod unfold = UnfoldMethod::poisson;
  Method method = Method::lsgp;
};

}  // namespace lsgp
