// SPDX-License-Identifier: GPL-3.0-or-later
// The best map of a surface whose borders are given.
#pragma once

#include "choices/border_gain.hpp"
#include "choices/symmetry_choice.hpp"
#include "measures/map_comparison.hpp"

namespace lsgp {

struct GivenPlaces {
  const GivenCones& cones;
  Symmetry symmetry;
  const Pins& pins;
};

// Through the given cones and others where these do not suffice: usual ones, symmetric ones, or those with which
// features can run along u and v, or along the lattice of seamless layouts; of several components, only those have
// cones for features that gain by them. Its findings are those to be told. Null where its cones take it beyond the
// objective's bound.
// Throws what `parameterize` and `complete_cones` throw.
Made best_map(const std::shared_ptr<BorderedSurface>& surface, const GivenPlaces& given, const MapOptions& options,
              Objective& objective, const Progress& progress);

// Choices among maps through cones for features and other ones.
class FeatureMaps {
 public:
  // maps: of the surface whose components are given.
  FeatureMaps(Borrowed<const SurfaceParts> parts, Borrowed<const MapThrough> maps, Borrowed<const MapOptions> options,
              Borrowed<const Objective> objective)
      : parts_(parts), maps_(maps), options_(options), objective_(objective) {}

  // The best seamless map through cones for features, or the other ones.
  Made best_on_lattice(const CompletedCones& for_features, SymmetryChoice& others, const Progress& progress) const;

  // The usual map, or where it releases marked features the one through cones for them, if that is worth it.
  Made straighter(const CompletedCones& for_features, const Made& usual, const Progress& progress) const;

  // The map, or the one in which no creases run along the lattice, where not all of them can and that is better.
  Made without_creases(const Made& along, const Progress& progress) const;

 private:
  // Whether a map through these cones may be better than that of the bound.
  bool may_be_worth_it(const CompletedCones& cones, const Progress& progress) const;
  // Whether that is better than a map will be once its creases run along the lattice.
  bool is_outdone(const MadeMap& plain) const {
    return objective_.bounds_whole(parts_) && is_outdone_at_creases(plain.result, *objective_.rival());
  }
  // Through cones for features, the best other one, or one through cones of both, by component.
  // features: of the other one.
  Made best_along(const Made& along, const Made& usual, UsualFeatures features, const Progress& progress) const;
  Made through(const CompletedCones& cones, const Progress& progress) const { return maps_(cones, options_, progress); }
  // The options without creases along the lattice.
  MapOptions unstraightened() const;

  const SurfaceParts& parts_;
  const MapThrough& maps_;
  const MapOptions& options_;
  const Objective& objective_;
};

}  // namespace lsgp
