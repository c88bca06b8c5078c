// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/presets.hpp"

namespace lsgp {

// Islands are split in all of them: what lies on itself can neither be painted nor baked, and the cuts of a seamless
// layout show nowhere. A longer search of a layout fills 1 % more with the few islands of paint, 3 % with those of
// bake.
PresetRow row_of(Preset preset) {
  PresetRow row{{}, {}, PackingEffort::good, {}};
  row.options.straighten = true;
  row.options.overlaps = Overlaps::split;
  switch (preset) {
    case Preset::paint:
      row.options.mode = Mode::low_stretch;
      row.options.compact = Compactness::sparing;
      row.effort = PackingEffort::quick;
      row.most_corners = 24;
      break;
    case Preset::tile: row.options.seamless = Seamless{}; break;
    case Preset::bake:
      row.options.mode = Mode::low_stretch;
      row.options.compact = Compactness::full;
      row.weights.islands = 0.1;
      row.weights.cuts = 0.05;
      row.weights.borders = row.weights.cones = 0;
      row.most_corners = 0;
      break;
  }
  return row;
}

MapOptions preset_options(Preset preset) { return {row_of(preset).options, {}}; }

Weights preset_weights(Preset preset) { return row_of(preset).weights; }

PackingEffort preset_effort(Preset preset) { return row_of(preset).effort; }

}  // namespace lsgp
