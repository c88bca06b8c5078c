// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/front_choice.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/number_text.hpp"
#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "choices/border_choice.hpp"
#include "choices/border_gain.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

VertexPairs outline_for(const Surface& surface, const GivenCones& given, const MapOptions& options,
                        const Progress& progress) {
  const bool is_plain = options.of_map.border == BorderMode::free && options.of_map.loop_turning.empty();
  const bool is_free = given.are_free() && surface.seams.rows() == 0 && options.of_map.seams != SeamMode::exact;
  if (!is_plain || !is_free || options.of_map.seamless || surface.directions.rows() > 0) return VertexPairs(0, 2);
  return costly_outline(surface, progress);
}

Made best_of_front(const Made& usual, const VertexPairs& outline, double target, Objective& objective,
                   const Progress& progress) {
  const SurfaceParts& parts = usual->surface->parts;
  const MapOptions& options = usual->options;
  const Pins no_pins;
  const EdgeSet earlier(parts.surface().borders);
  const auto refuse = [&](const std::string& why) {
    objective.note_unmade(around_front.name, Objective::infinity, why);
    return Made();
  };
  const auto make = [&](const std::shared_ptr<BorderedSurface>& bordered, const Progress& share) {
    const VertexPairs& all = bordered->surface().borders;
    const VertexPairs further = filtered(all, [&](Eigen::Index e) { return !earlier.has(all(e, 0), all(e, 1)); });
    const PerComponent<char> ends = have_edges(parts, further);
    const MapThrough map = maps_of(bordered, no_pins);
    const CompletedCones others = joined(usual->cones, {}, parts.surface(), vertices_on(parts, ends));
    Made made;
    try {
      made = map(others, options, share);
    } catch (const Error& error) {
      if (error.code() == Code::cancelled) throw;
      return refuse(std::string("is refused: ") + name(error.code()));
    }
    const double stretch = made->result.distortion.l2_stretch;
    const double most = std::max(target, usual->result.distortion.l2_stretch);
    if (stretch <= most) return made;
    return refuse(concat("is stretched by ", decimals(100 * (stretch - 1), 2), " %, more than ",
                         decimals(100 * (most - 1), 2), " %"));
  };
  const PerComponent<char> has_tubes = [&] {
    PerComponent<char> out(parts.count(), 0);
    if (!usual->surface->in_tubes) return out;
    const PerTriangle<char>& in_tubes = *usual->surface->in_tubes;
    for (std::size_t f = 0; f < in_tubes.size(); ++f) {
      if (in_tubes[f] && parts.of_triangle()[f] != none) out[parts.of_triangle()[f]] = 1;
    }
    return out;
  }();
  const VertexPairs possible = filtered(outline, [&](Eigen::Index e) {
    const Index f = parts.triangle_at(outline(e, 0), outline(e, 1));
    return f != none && parts.of_triangle()[f] != none && !has_tubes[parts.of_triangle()[f]];
  });
  if (possible.rows() == 0) return usual;
  const Made best = best_around_front(usual, possible, make, objective, progress);
  if (best != usual) tell_findings(*best, options.of_map);
  return best;
}

}  // namespace lsgp
