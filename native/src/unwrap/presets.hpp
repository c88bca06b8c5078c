// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "lsgp/auto_unwrap.hpp"

namespace lsgp {

// A row of the table of presets.
struct PresetRow {
  Options options;
  Weights weights;
  PackingEffort effort;
  // Hard surfaces end at their creases where their curvature sits at more corners than these, at which cones serve as
  // well and the texture runs on; none: it runs on wherever creases run along the tiles.
  std::optional<Index> most_corners;
};

PresetRow row_of(Preset preset);

}  // namespace lsgp
