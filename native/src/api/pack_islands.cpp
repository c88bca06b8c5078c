// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/packing.hpp"
#include "packing/best_layout.hpp"
#include "packing/body.hpp"
#include "packing/digits.hpp"
#include "packing/gaps.hpp"
#include "packing/layout_search.hpp"
#include "pipeline/validation.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

constexpr int most_tiles = 100;  // from UDIM tile 1001 to 1100
// Of coordinates whose squares do not overflow.
constexpr int most_exponent = 300;

// The triangles for which that holds, for errors.
template <typename Condition>
Elements triangles_where(const std::vector<Index>& island, Condition condition) {
  Elements out{ElementKind::triangles, {}};
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (condition(static_cast<Index>(t))) out.indices.push_back(static_cast<Index>(t));
  }
  return out;
}

Elements triangles_of(const std::vector<Index>& island, const Array<Index>& islands) {
  Array<char> is_one(*std::max_element(islands.begin(), islands.end()) + 1, 0);
  for (const Index i : islands) is_one[i] = 1;
  return triangles_where(island, [&](Index t) {
    const Index i = element(island, t);
    return i >= 0 && i < ssize(is_one) && is_one[i];
  });
}

void require_length(std::size_t length, Index island_count, const char* what) {
  if (length == 0 || static_cast<Index>(length) >= island_count) return;
  throw Error(Code::wrong_parameter,
              concat("There are ", length, " ", what, "; pass one for each of the ", island_count, " islands."));
}

void require_sizes(const PackingOptions& options) {
  // Rasters have at most 2^10 texels on the side of a square as large as the area: beyond, less than one lies across.
  constexpr double most_aspect = 1 << 20;
  const UvRectangle area = options.area.value_or(UvRectangle{});
  const double width = area.right - area.left, height = area.top - area.bottom;
  const auto is_length = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!(is_length(width) && width > 0 && is_length(height) && height > 0 && is_length(options.margin) &&
        is_length(options.snap) && is_length(options.seconds.value_or(0)) && options.tiles >= 1 &&
        options.tiles <= most_tiles)) {
    throw Error(
        Code::wrong_parameter,
        concat("The area is from ", area.left, ", ", area.bottom, " to ", area.right, ", ", area.top, ", the margin ",
               options.margin, ", blocks ", options.snap, ", seconds ", options.seconds.value_or(0), ", tiles ",
               options.tiles, "; pass finite numbers, an area with some room and from 1 to ", most_tiles, " tiles."));
  }
  if (!options.fill && !options.area) return;
  const double inner_width = width - 2 * options.margin, inner_height = height - 2 * options.margin;
  const double least = std::min(inner_width, inner_height), most = std::max(inner_width, inner_height);
  if (least > 0 && most <= most_aspect * least) return;
  throw Error(Code::wrong_parameter, concat("Inside a margin of ", options.margin, " the area is ", inner_width, " by ",
                                            inner_height, "; pass one with some room, of which no side is more than ",
                                            most_aspect, " times as long as the other, or a smaller margin."));
}

// name: of the texture coordinates.
Index require_valid(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options,
                    const char* name = "corner_uv") {
  if (corner_uv.rows() != 3 * ssize(island)) {
    throw Error(Code::wrong_parameter, concat(name, " has ", corner_uv.rows(), " texture coordinates of corners; pass ",
                                              3 * ssize(island), ", three for each triangle."));
  }
  require_numbers(island, "an island");
  require_numbers(options.groups, "a group");
  Index island_count = 0;
  for (const Index i : island) island_count = std::max(island_count, i + 1);
  require_length(options.groups.size(), island_count, "groups");
  require_length(options.locks.size(), island_count, "locks");
  require_sizes(options);
  const Elements lost = triangles_where(island, [&](Index t) {
    return element(island, t) >= 0 && !corner_uv.middleRows<3>(3 * static_cast<Eigen::Index>(t)).allFinite();
  });
  if (!lost.indices.empty()) {
    throw Error(Code::wrong_parameter,
                concat(name, " is not finite at triangle ", lost.indices[0],
                       ", which lies in an island; give such triangles island -1."),
                lost);
  }
  return island_count;
}

// Of islands that may be scaled, whose unit is the root of their area: what turning or scaling all of them loses is
// rounded away, and the gap that layouts add for rounding is wider.
constexpr double quantum_of_islands = 0x1p-32;

// Lengths as multiples of a power of two, so that no square of one overflows or vanishes and no digit hangs on it, and
// of a further factor.
struct Unit {
  int exponent = 0;
  double factor = 1;

  double of(double length) const { return std::ldexp(length, -exponent) / factor; }
  double back(double length) const { return std::ldexp(length * factor, exponent); }
};

// Of the texture coordinates, and of the area, the margin and blocks.
struct Units {
  Unit given, packed;
  double of_outlines = 0;  // of which their coordinates are multiples, 0: of none
};

// The root of the area of all islands, 1 if it has hardly any. It does not hang on the order of triangles.
double root_of_area(const CornerUv& corner_uv, const std::vector<Index>& island, const Unit& unit) {
  Array<double> areas;
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] < 0) continue;
    const auto row = 3 * static_cast<Eigen::Index>(t);
    const auto corner = [&](Eigen::Index c) {
      return Complex(unit.of(corner_uv(row + c, 0)), unit.of(corner_uv(row + c, 1)));
    };
    areas.push_back(std::abs(doubled_area(corner(0), corner(1), corner(2))) / 2);
  }
  std::sort(areas.begin(), areas.end());
  const double root = std::sqrt(std::accumulate(areas.begin(), areas.end(), 0.0));
  constexpr double least = 1e-100;  // so that no square of a coordinate overflows
  return root > least ? root : 1;
}

Units choose_units(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& options) {
  double largest = 0;
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] >= 0)
      largest = std::max(largest, corner_uv.middleRows<3>(3 * static_cast<Eigen::Index>(t)).cwiseAbs().maxCoeff());
  }
  const auto any_keeps = [&](bool IslandLock::* what) {
    return std::any_of(options.locks.begin(), options.locks.end(), [&](const IslandLock& lock) { return lock.*what; });
  };
  const bool has_place = any_keeps(&IslandLock::place), has_size = !options.fill || any_keeps(&IslandLock::scale);
  Units units;
  if (!options.fill && !options.area && !has_place) {
    std::frexp(std::max(largest, options.margin), &units.given.exponent);
    units.packed = units.given;
    return units;
  }
  std::frexp(largest, &units.given.exponent);
  const UvRectangle area = options.area.value_or(UvRectangle{});
  units.packed.exponent = std::ilogb(std::max(area.right - area.left, area.top - area.bottom));
  // Islands that lie in tiles or blocks already may stay there; those of ten tiles in a row are less than 2^4 away.
  constexpr int exponent_of_row = 4;
  static_assert(tiles_in_row <= 1 << exponent_of_row);
  const int away = units.given.exponent - units.packed.exponent;
  const bool may_stay = (options.tiles > 1 || options.snap > 0) && away <= exponent_of_row && -away <= most_exponent;
  if (!has_place && !has_size && !may_stay) {
    if (options.snap > 0) return units;  // islands begin at blocks, as they are
    units.given.factor = root_of_area(corner_uv, island, units.given);
    units.of_outlines = quantum_of_islands;
    return units;
  }
  // What keeps its place or size has to fit to the area.
  if (units.given.exponent - units.packed.exponent > most_exponent) {
    throw Error(Code::wrong_parameter, concat("corner_uv holds numbers of about 2^", units.given.exponent,
                                              ", far outside the area of about 2^", units.packed.exponent,
                                              " that islands are packed into. Move or scale them to it."));
  }
  units.given = units.packed;
  return units;
}

PackingOptions in_unit(PackingOptions options, const Unit& unit) {
  options.margin = unit.of(options.margin);
  options.snap = unit.of(options.snap);
  if (options.area) {
    auto& [left, bottom, right, top] = *options.area;
    options.area = UvRectangle{unit.of(left), unit.of(bottom), unit.of(right), unit.of(top)};
  }
  return options;
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

// What `find` returns; islands that have no room are told by their triangles.
template <typename Find>
auto found_with_room(const std::vector<Index>& island, Find find) {
  try {
    return find();
  } catch (const NoRoom& error) {
    throw Error(Code::wrong_parameter, error.message, triangles_of(island, error.islands));
  }
}

}  // namespace

CornerUv pack_islands(const CornerUv& corner_uv, const std::vector<Index>& island, const PackingOptions& given,
                      const Progress& progress, const CornerUv* packed_quickly) {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  monitor.advance(0);
  const Index island_count = require_valid(corner_uv, island, given);
  found_with_room(island, [&] { require_digits(corner_uv, island, given); });
  if (packed_quickly != nullptr) {
    require_valid(*packed_quickly, island, given, "packed_quickly");
    if (given.effort == PackingEffort::quick) {
      monitor.advance(1);
      return *packed_quickly;
    }
  }
  const auto [unit, packed_unit, of_outlines] = choose_units(corner_uv, island, given);
  const PackingOptions options = in_unit(given, packed_unit);
  CornerUv scaled = corner_uv;
  for (double& coordinate : scaled.reshaped()) coordinate = std::ldexp(coordinate, -unit.exponent);
  const Array<Body> bodies = bodies_of(scaled, island, options, unit.factor, of_outlines);
  require_locks_inside(bodies, island, options.area.value_or(UvRectangle{}));
  CornerUv out = corner_uv;
  const auto is_free = [](const Body& body) { return !body.keeps_place; };
  if (std::any_of(bodies.begin(), bodies.end(), is_free)) {
    std::optional<double> side_of_quick;  // in the unit of lengths in the search
    if (packed_quickly != nullptr)
      side_of_quick =
          root_of_area(scaled, island, {}) / unit.factor / root_of_area(*packed_quickly, island, packed_unit);
    const double unit_of_options = packed_unit.back(1);
    const std::optional<PackedLayout> found =
        found_with_room(island, [&] { return best_layout(bodies, options, unit_of_options, side_of_quick, monitor); });
    if (!found) {
      monitor.advance(1);
      return *packed_quickly;
    }
    const Array<BodyMotion>& motions = found->motions;
    Array<Index> body_of(island_count, -1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      for (const Index i : bodies[b].islands) body_of[i] = static_cast<Index>(b);
    }
    for (std::size_t t = 0; t < island.size(); ++t) {
      if (island[t] < 0 || bodies[body_of[island[t]]].keeps_place) continue;
      const Body& body = bodies[body_of[island[t]]];
      const auto& [tile, factor, shift] = motions[body_of[island[t]]];
      const Complex offset = shift + corner_of_tile(tile);
      for (Eigen::Index row = 3 * static_cast<Eigen::Index>(t); row < 3 * static_cast<Eigen::Index>(t) + 3; ++row) {
        const Complex z = (Complex(scaled(row, 0), scaled(row, 1)) - body.low) / unit.factor * factor + offset;
        out(row, 0) = packed_unit.back(z.real());
        out(row, 1) = packed_unit.back(z.imag());
      }
      if (out.middleRows<3>(3 * static_cast<Eigen::Index>(t)).allFinite()) continue;
      throw Error(
          Code::wrong_parameter,
          "The square around the packed islands is larger than numbers can hold. Scale corner_uv and the margin "
          "down.");
    }
  }
  monitor.advance(1);
  return out;
}

double usual_margin(const CornerUv& corner_uv, const std::vector<Index>& island, int tiles) {
  constexpr double least = 0.5 / 1024;
  constexpr double filled = 0.7;  // of a tile, by islands and gaps, as layouts are about
  // Of the room of islands, what gaps take at most: with more, these and not the shapes of islands would decide what
  // stays empty, which is about 0.4 of that room.
  constexpr double most_gaps = 0.25;
  PackingOptions options;
  options.tiles = tiles;
  require_valid(corner_uv, island, options);
  double area = 0, around = 0, islands = 0;
  for (std::size_t t = 0; t < island.size(); ++t) {
    if (island[t] < 0) continue;
    const auto corners = corner_uv.middleRows<3>(3 * static_cast<Eigen::Index>(t));
    const Eigen::Vector2d a = (corners.row(1) - corners.row(0)).transpose();
    const Eigen::Vector2d b = (corners.row(2) - corners.row(0)).transpose();
    area += std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
  }
  for (const Box& box : boxes_of_islands(corner_uv, island)) {
    if (box.left > box.right) continue;
    around += box.right - box.left + box.top - box.bottom;
    ++islands;
  }
  const double usual = PackingOptions().margin;
  const double side = std::sqrt((1 + most_gaps) * area / (filled * tiles));
  if (!(side > 0) || !std::isfinite(side)) return usual;
  // Gaps g take g * around + islands * g^2.
  const double gap = (std::sqrt(around * around + 4 * islands * most_gaps * area) - around) / (2 * islands);
  return std::clamp(std::ceil(gap / (2 * side) / quantum_of_islands) * quantum_of_islands, least, usual);
}

}  // namespace lsgp
