// SPDX-License-Identifier: GPL-3.0-or-later
// At which creases components end.
#pragma once

#include <optional>

#include "choices/symmetry_choice.hpp"
#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

struct CreaseBorders {
  VertexPairs required;  // which components end at in any case
  VertexPairs possible;  // at which others end if their maps gain by it
  // In a seamless layout without marked features: those possible carry nearly all curvature of their components, so
  // that it takes hardly any cones if these end there.
  bool carry_all = false;
};

struct CreaseRules {
  std::optional<Index> most_corners;  // of the preset
  const VertexPairs& sharp;           // edges that are creases whatever their angle
};

// Bake requires those of all hard components; Paint those of components with curvature at more than 24 vertices, since
// fewer can be cones, across which the texture continues. Both may gain by those of other components with half of their
// curvature on creases, unless the number of cones is given. Seamless layouts on squares, as with Tile, may gain by
// those of hard components where no cones or seams are marked. With straight borders or prescribed turning: none.
// progress: without time of its own.  Throws what `crease_borders` throws.
CreaseBorders crease_borders_for(const Surface& surface, const GivenCones& given, const CreaseRules& rules,
                                 const MapOptions& options, const Progress& progress);

// The map of the surface with the best of possible borders: they are tried on components that may gain by them, and all
// of them where no map is found without.
// make: its maps.  Throws what `make` throws.
Made best_at_creases(BorderedSurfaces& surfaces, const CreaseBorders& creases, const MakeMap& make,
                     Objective& objective, const Progress& progress);

// The map, or one in which components also end at the outline of what the front sees, if it costs less: no cut leads
// into the front then. What is seen of the outline costs as cuts do.
// make: maps of the surface with some of these borders.  Throws what `make` throws.
Made best_around_front(const Made& usual, const VertexPairs& outline, const MakeMap& make, Objective& objective,
                       const Progress& progress);

}  // namespace lsgp
