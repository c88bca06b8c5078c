// SPDX-License-Identifier: GPL-3.0-or-later
// Cones for a map: given ones, and automatic ones where these do not suffice.
#pragma once

#include <optional>
#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/placement.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/solver.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// The options of maps whose cones are still to be chosen.
struct MapOptions {
  Options of_map;  // but for its prescription
  // None: manual where any cone has an angle, as placed ones do, otherwise least_distortion.
  std::optional<PrescriptionRule> prescription;

  // Those of the map through these cones.
  LSGP_API Options through(const Cones& cones) const;
};

// How many automatic cones a component gets, and where.
struct CompletionOptions {
  std::optional<int> count;  // on each component that gets some; none: as few as bring the L2 stretch to the target
  double target = PlacementOptions().target;
  bool symmetric = false;  // as in PlacementOptions; only where no cones are given
  // (m) Which triangles are of charts between seams that get none; empty: every chart may.
  std::vector<char> without;
  std::optional<int> most;  // as in PlacementOptions
};

struct CompletedCones {
  Cones cones;                         // given ones first
  std::optional<Placement> placement;  // on the components that needed cones, or were tried for some
  std::optional<double> target;        // the stretch that determined their number
  bool is_symmetric = false;           // they mirror each other, so that cuts may as well
};

// Components without cones get some as far as they need them, and so do those whose budget does not close with theirs.
// Throws what `place_cones` throws where no cones are given; otherwise such components stay without.
LSGP_API CompletedCones complete_cones(Solver& solver, const Cones& given, const CompletionOptions& completion = {},
                                       const MapOptions& options = {}, const Progress& progress = {});

// Cones with which marked features and, in seamless layouts with `straighten`, creases of hard surfaces can run along u
// and v, as of `feature_cones`, and automatic ones on other components. None where features are not aligned with these
// options, or where there are no such cones.
LSGP_API std::optional<CompletedCones> complete_feature_cones(Solver& solver, const MapOptions& options,
                                                              double target = PlacementOptions().target,
                                                              const Progress& progress = {});

// The findings of a map through these cones and, as far as they hold for it, those of their placement.
LSGP_API std::vector<Finding> findings_of(const CompletedCones& cones, const Result& result, const Options& options);

}  // namespace lsgp
