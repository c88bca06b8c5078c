// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/digits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/text.hpp"
#include "packing/body.hpp"

namespace lsgp {

namespace {

// How many times as large as an island its coordinates may be: of 53 binary digits 20 tell its shape then.
constexpr double most_times = 0x1p33;
// The side of the square that islands take without gaps, relative to that of one as large as the squares around them.
constexpr double taken_by_islands = 2;
// Islands count that keep their digits in a square so many times as large as all of them take.
constexpr double room_for_gaps = 8;
// What is told is rounded to two digits; then it still fits.
constexpr double safe = 0.9;

constexpr double unlimited = std::numeric_limits<double>::infinity();

struct IslandExtent {
  Index island = 0;
  double length = 0;  // the longer side of the island's box
  bool is_scaled = false;
};

// Of the islands that are moved and are no points.
Array<IslandExtent> extents_of_moved(const CornerUv& corner_uv, const std::vector<Index>& island,
                                     const PackingOptions& options) {
  const Array<Box> boxes = boxes_of_islands(corner_uv, island);
  Array<IslandExtent> out;
  for (Index i = 0; i < ssize(boxes); ++i) {
    const IslandLock lock = options.locks.empty() ? IslandLock{} : element(options.locks, i);
    const double length = std::min(std::max(boxes[i].right - boxes[i].left, boxes[i].top - boxes[i].bottom),
                                   std::numeric_limits<double>::max());
    if (!lock.place && length > 0) out.push_back({i, length, options.fill && !lock.scale});
  }
  return out;
}

// The side of a square as large as those around the islands.
double side_of_all(const Array<IslandExtent>& extents, bool are_scaled) {
  double out = 0;
  for (const IslandExtent& extent : extents) {
    if (extent.is_scaled == are_scaled) out = std::hypot(out, extent.length);
  }
  return out;
}

}  // namespace

void require_digits(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options) {
  Array<IslandExtent> extents = extents_of_moved(corner_uv, island, options);
  const UvRectangle area = options.area.value_or(UvRectangle{});
  const double side_of_area = std::sqrt(area.right - area.left) * std::sqrt(area.top - area.bottom);
  double largest = 0;  // of those that are scaled, by which they are divided first, as squares of theirs may overflow
  for (const IslandExtent& extent : extents) largest = std::max(largest, extent.is_scaled ? extent.length : 0);
  for (IslandExtent& extent : extents) extent.length /= extent.is_scaled ? largest : 1;
  const double scale = side_of_area / (taken_by_islands * side_of_all(extents, true));
  for (IslandExtent& extent : extents) extent.length *= extent.is_scaled ? scale : 1;
  const double taken = taken_by_islands * std::hypot(side_of_all(extents, true), side_of_all(extents, false));
  const auto limit = [&](const IslandExtent& extent) {  // of the coordinates of one
    const double own = most_times * extent.length;
    return own >= room_for_gaps * taken ? own : unlimited;
  };
  double most = unlimited;
  for (const IslandExtent& extent : extents) most = std::min(most, limit(extent));
  const auto islands_before = [&](double coordinate) {
    Array<Index> out;
    for (const IslandExtent& extent : extents) {
      if (limit(extent) < coordinate) out.push_back(extent.island);
    }
    return out;
  };
  const double away = std::max(std::abs(area.left), std::abs(area.bottom));  // from the origin
  if (away > most / 2) {
    throw NoRoom{concat("The area begins at ", area.left, ", ", area.bottom,
                        ", so far from the origin that numbers there are too far apart for the shapes of islands. Pass "
                        "one that begins at numbers of at most ",
                        rounded(safe * most / 2, 2), "."),
                 islands_before(2 * away)};
  }
  if (options.fill) return;
  const double margins = 2 * std::ceil(std::sqrt(static_cast<double>(extents.size())));  // along a side
  const double farthest = away + taken + margins * options.margin;
  if (farthest <= most) return;
  throw NoRoom{concat("The margin is ", options.margin,
                      ", so large that numbers are too far apart for the shapes of islands that lie between such gaps. "
                      "Pass one of at most ",
                      rounded(safe * (most - away - taken) / margins, 2), "."),
               islands_before(farthest)};
}

}  // namespace lsgp
