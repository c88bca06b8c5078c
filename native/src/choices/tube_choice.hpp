// SPDX-License-Identifier: GPL-3.0-or-later
// Whether tubes become strips.
#pragma once

#include "choices/border_choice.hpp"
#include "lsgp/tubes.hpp"
#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// The tubes of a surface, which may become strips. None in seamless layouts, whose cuts are to be invisible, and none
// with straight or turning borders or a number of cones; where seams alone are cut, those that these open. None on
// closed components with creases that end nowhere, such as washers, which unfold between these. progress: without time
// of its own.  Throws what `find_tubes` throws.
Tubes tubes_for(const Surface& surface, const GivenCones& given, const CreaseBorders& creases,
                const MapOptions& options, const Progress& progress);

struct EndsOfSurface {
  const CreaseBorders& creases;
  const Tubes& tubes;
};

enum class TubesBecome { strips, anything };
// The map of a surface whose tubes become strips or not.
using MakeWithTubes = std::function<Made(const std::shared_ptr<BorderedSurface>&, TubesBecome, const Progress&)>;

// The map of a surface that ends at the borders required at its creases, or at others that are possible: with its tubes
// as they are or as strips, whichever costs less.
Made best_of_tubes(const Surface& surface, const EndsOfSurface& ends, const MakeWithTubes& make, Objective& objective,
                   const Progress& progress);

// Adds a warning where a map's straight strips are stretched by more than placed cones may leave.
void tell_stretched_strips(MadeMap& made);

}  // namespace lsgp
