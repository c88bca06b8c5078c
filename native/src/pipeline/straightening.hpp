// SPDX-License-Identifier: GPL-3.0-or-later
// The search for straight sides that hardly cost any stretch.
#pragma once

#include <optional>

#include "pipeline/component_map.hpp"
#include "prescription/parallel_transport.hpp"
#include "repair/low_stretch.hpp"
#include "repair/straight_sides.hpp"

namespace lsgp {

// What is to be straight: marked features, and nearly straight sides, and creases inside as well; or the sides of a
// strip, each as a whole.
enum class SideKinds { marked, with_sides, with_creases, of_strip };

// The sides of these kinds in a map; none if there is nothing to do.
std::optional<StraightSides> sides_to_straighten(const CutSurface& surface, const ComponentMap& map, SideKinds kinds,
                                                 LineReading reading = LineReading::nearest);

// A map of low stretch that is to be changed.
struct StraighteningTask {
  const CutSurface& surface;
  const ParallelTransport& connection;  // that the map realizes
  StretchOptions options;
  StepHook before_step;
};

// The map with as many of these sides straight as its natural stretch, `ComponentMap::natural_l2`, allows without flips
// or overlaps of an island with itself, those of the boundary before creases inside, and marked features before both,
// which may cost a tenth of stretch; none if it allows no side. Where marked features stay bent, their other readings
// are tried, and replace it where more of their length is straight.  kinds: of the sides.
std::optional<ComponentMap> with_straight_sides(const StraighteningTask& task, const ComponentMap& map, SideKinds kinds,
                                                StraightSides straight);

// The same for a map that was cut into islands, which may have been moved. Islands may be shifted.
// Leaves the map unchanged if no side can be made straight.
void straighten_islands(const MetricMesh& surface, SideKinds kinds, const StretchOptions& options,
                        const StepHook& before_step, ComponentMap& map);

// The mesh with all sides of the islands marked as features, as those of strips are.
HalfedgeMesh with_marked_sides(const HalfedgeMesh& mesh, const ComponentMap& map);

}  // namespace lsgp
