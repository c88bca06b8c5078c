// SPDX-License-Identifier: GPL-3.0-or-later
// Seamless layouts (the paper's section 8): every component on one grid, exact in the precision that is stored.
#pragma once

#include <vector>

#include "component_map.hpp"
#include "components.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"
#include "monitor.hpp"

namespace lsgp {

// A component's map, its angles multiples of the lattice's turn, and what it was made from.
struct SeamlessPart {
  const Component* component;
  ComponentTask* task;
  ComponentMap* map;
  ComponentSystem* system;  // of the map
};

// Throws WRONG_PARAMETER.
void require_valid(const Seamless& seamless, const Options& options, const Pins& pins);

// Throws SEAMLESS_IMPOSSIBLE for a map that has flipped triangles or wrong angles.
void require_quantizable(const HalfedgeMesh& mesh, const ComponentMap& map);

// Brings the cuts of all maps onto one grid and the maps into texture coordinates: side by side, cut vertices on
// binary fractions, so that transitions hold exactly in float32 (on triangular lattices, whose points are irrational,
// to its last digit).  Maps are made again where cones are merged.  unit_scale: of the components' positions to the
// caller's.  Throws GRID_TOO_COARSE, SEAMLESS_IMPOSSIBLE.
SeamlessReport make_seamless(const Options& options, double unit_scale, std::vector<SeamlessPart>& parts,
                             std::vector<Finding>& findings, Monitor& monitor);

}  // namespace lsgp
