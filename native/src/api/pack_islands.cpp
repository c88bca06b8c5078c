// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/packing.hpp"
#include "packing/body.hpp"
#include "packing/gaps.hpp"
#include "packing/layout_search.hpp"

namespace lsgp {

namespace {

constexpr int tiles_in_row = 10;  // from UDIM tile 1001 to 1010

// The triangles of islands, for errors.
Elements triangles_of(const std::vector<Index>& island, const Array<Index>& islands) {
  Elements out{ElementKind::triangles, {}};
  Array<char> is_one(*std::max_element(islands.begin(), islands.end()) + 1, 0);
  for (const Index i : islands) is_one[i] = 1;
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] >= 0 && island[t] < ssize(is_one) && is_one[island[t]]) out.indices.push_back(static_cast<Index>(t));
  }
  return out;
}

void require_locks_inside(const Array<Body>& bodies, const std::vector<Index>& island, const UvRectangle& area) {
  Array<Index> outside, kept;
  Array<Outline> outlines;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].keeps_place) continue;
    kept.push_back(static_cast<Index>(b));
    outlines.push_back(bodies[b].outline.moved(1, bodies[b].origin));
    const Box box = outlines.back().box();
    if (box.left < area.left || box.right > area.right || box.bottom < area.bottom || box.top > area.top)
      outside.insert(outside.end(), bodies[b].islands.begin(), bodies[b].islands.end());
  }
  if (!outside.empty()) {
    throw Error(Code::wrong_parameter,
                concat(count(ssize(outside), "island that keeps its place lies", "islands that keep their place lie"),
                       " outside the area to fill: ", list(outside), ". Unlock them, or pass an area that has them."),
                triangles_of(island, outside));
  }
  const auto [one, other] = overlapping_pair(outlines);
  if (one < 0) return;
  Array<Index> both = bodies[kept[one]].islands;
  both.insert(both.end(), bodies[kept[other]].islands.begin(), bodies[kept[other]].islands.end());
  throw Error(Code::wrong_parameter,
              concat("Islands that keep their place overlap: ", list(both), ". Unlock one of them, or group them."),
              triangles_of(island, both));
}

}  // namespace

CornerUv pack_islands(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options,
                      const Progress& progress) {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  monitor.advance(0);
  const Array<Body> bodies = bodies_of(corner_uv, island, options);
  require_locks_inside(bodies, island, options.area.value_or(UvRectangle{}));
  CornerUv out = corner_uv;
  const auto is_free = [](const Body& body) { return !body.keeps_place; };
  if (std::any_of(bodies.begin(), bodies.end(), is_free)) {
    const Array<BodyMotion> motions = LayoutSearch(bodies, options, monitor).best();
    Index island_count = 0;
    for (const Index i : island) island_count = std::max(island_count, i + 1);
    Array<Index> body_of(island_count, -1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      for (const Index i : bodies[b].islands) body_of[i] = static_cast<Index>(b);
    }
    for (std::size_t t = 0; t < island.size(); ++t) {
      if (island[t] < 0 || bodies[body_of[island[t]]].keeps_place) continue;
      const Body& body = bodies[body_of[island[t]]];
      const auto& [tile, factor, shift] = motions[body_of[island[t]]];
      const int column = tile % tiles_in_row, tile_row = tile / tiles_in_row;
      const Complex offset = shift + Complex(column, tile_row);
      for (Eigen::Index row = 3 * static_cast<Eigen::Index>(t); row < 3 * static_cast<Eigen::Index>(t) + 3; ++row) {
        const Complex z = (Complex(out(row, 0), out(row, 1)) - body.origin) * factor + offset;
        out(row, 0) = z.real();
        out(row, 1) = z.imag();
      }
    }
  }
  monitor.advance(1);
  return out;
}

}  // namespace lsgp
