// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/island_division.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// As a fraction of the area of all islands: smaller pieces are not cut off, nor are larger ones of few faces of smooth
// surfaces.
constexpr double smallest_piece = 0.01, smallest_of_few = 0.06, smallest_of_long = 0.001;
// Of islands that are smaller than this, only long and narrow ones are divided; pieces are at least a share of them.
constexpr double small_island = 0.02, smallest_share = 0.1;
constexpr Index few_faces = 4;
// How far the texel density of a piece may differ from that of all islands, relative to how far that of faces does;
// in area, and at most so far that sides of texels of two pieces differ by a twentieth.
constexpr double most_uneven = 0.5, hardly_uneven = 0.01, clearly_uneven = 0.05;
// Of islands that occupy more than a multiple of their area, as much for each further multiple: the more they leave
// empty, the less the difference matters.
constexpr double wasteful = 4, uneven_if_wasteful = 0.05;
// Least saving, as a fraction of the area of all islands: for a cut as long as the square root of that area, and for
// each additional island.
constexpr double price_of_cut = 0.15, price_of_island = 0.01;
// Multiplies both with Compactness::sparing.
constexpr double sparing_factor = 8;
// An island is assumed to occupy the mean area of its convex hull and its smallest box. If its smallest bounding square
// exceeds a fraction of the shared square, it also blocks part of that square for others.
constexpr double fill = 0.62, large = 0.7, cost_of_large = 0.5;
constexpr Index most_pieces = 8;  // of one division
constexpr int directions = 12;
constexpr int most_lines = 2;
constexpr double operations_a_cell = 8 * Support::turns;  // comparing and keeping how far it reaches
constexpr double same_line = 1e-6;                        // of normals, and of offsets relative to the extent

// Adds the mirror images of lines that are not among them.
void add_images(const Line& axis, double extent, Array<Line>& lines) {
  const auto are_alike = [&](const Line& a, const Line& b) {
    return std::abs(a.normal - b.normal) < same_line && std::abs(a.offset - b.offset) < same_line * extent;
  };
  for (std::size_t i = 0, count = lines.size(); i < count; ++i) {
    const Line image = lines[i].mirrored_at(axis);
    const auto is_image = [&](const Line& other) {
      return are_alike(other, image) || are_alike(other.reversed(), image);
    };
    if (std::none_of(lines.begin(), lines.end(), is_image)) lines.push_back(image);
  }
}

using Sides = DivisionSearch::Sides;
static_assert(most_lines * division_positions <= std::numeric_limits<Sides>::digits);

struct MergedCells {
  IslandCells cells;  // without their centers
  Array<Sides> sides;
};

// Cells that hang together on the same sides, which no division separates.
MergedCells merge(const IslandCells& cells, const Array<Sides>& sides) {
  UnionFind sets(cells.count());
  for (const IslandCells::Link& link : cells.links) {
    if (sides[link.cells[0]] == sides[link.cells[1]]) sets.unite(link.cells[0], link.cells[1]);
  }
  MergedCells out;
  Array<Index> number(cells.count(), none);
  for (Index cell = 0; cell < cells.count(); ++cell) {
    Index& own = number[sets.find(cell)];
    if (own == none) {
      own = out.cells.count();
      out.sides.push_back(sides[cell]);
      out.cells.area.push_back(0);
      out.cells.map_area.push_back(0);
      out.cells.faces.push_back(0);
      out.cells.support.emplace_back();
    }
    out.cells.area[own] += cells.area[cell];
    out.cells.map_area[own] += cells.map_area[cell];
    out.cells.faces[own] += cells.faces[cell];
    out.cells.support[own].add(cells.support[cell]);
  }
  for (const IslandCells::Link& link : cells.links) {
    const Index here = number[sets.find(link.cells[0])], there = number[sets.find(link.cells[1])];
    if (here != there) out.cells.links.push_back({{here, there}, link.length, link.is_smooth});
  }
  return out;
}

}  // namespace

Support::Support(const Array<Complex>& points) : Support() {
  static const std::array<Complex, 4 * turns> unit = [] {
    std::array<Complex, 4 * turns> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::polar(1.0, M_PI / 2 * static_cast<double>(i) / turns);
    return out;
  }();
  for (const Complex point : points) {
    for (std::size_t i = 0; i < unit.size(); ++i) {
      const double along = point.real() * unit[i].real() + point.imag() * unit[i].imag();
      along_[i] = std::max(along_[i], along);
    }
  }
}

double Support::hull_area() const {
  constexpr std::size_t count = 4 * turns;
  static const double cosine = std::cos(M_PI / 2 / turns), sine = std::sin(M_PI / 2 / turns);
  double doubled = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double beside = along_[(i + 1) % count] + along_[(i + count - 1) % count];
    doubled += along_[i] * (beside - 2 * cosine * along_[i]) / sine;
  }
  return doubled / 2;
}

DivisionSearch::DivisionSearch(const SharedSquare& square)
    : area_(square.area), price_factor_(square.filling == Compactness::sparing ? sparing_factor : 1) {}

Index DivisionSearch::pieces_of_strip(double length) const {
  const double least = std::ceil(length / std::sqrt(large * area_ / fill));
  return static_cast<Index>(std::min<double>(most_pieces, least));
}

double DivisionSearch::least_gain() const { return price_factor_ * price_of_island * area_; }

bool DivisionSearch::may_be_cut_off(const Piece& piece, const WholeIsland& island) const {
  const double unevenness = std::abs(std::log(piece.map_area / piece.area));
  const bool is_even = unevenness <= std::clamp(most_uneven * island.unevenness, hardly_uneven, clearly_uneven);
  const bool is_worth_it = unevenness * island.area <= uneven_if_wasteful * (island.demand - wasteful * island.area);
  if (!is_even && !is_worth_it) return false;
  if (island.area < small_island * area_) return piece.area >= smallest_share * island.area;
  if (island.is_long && piece.area >= smallest_of_long * area_ && piece.faces > few_faces) return true;
  const bool is_scrap = piece.faces <= few_faces && piece.ends_smoothly;
  return piece.area >= (is_scrap ? smallest_of_few : smallest_piece) * area_;
}

WholeIsland DivisionSearch::describe(double area, const Support& support) const {
  double box = std::numeric_limits<double>::infinity(), square = box;
  for (std::size_t turn = 0; turn < Support::turns; ++turn) {
    box = std::min(box, support.width(turn) * support.height(turn));
    square = std::min(square, std::max(support.width(turn), support.height(turn)));
  }
  const double too_large = std::max(0.0, square * square - large * area_ / fill);
  return {area, (support.hull_area() + box) / 2 + cost_of_large * too_large, too_large > 0};
}

double DivisionSearch::worth(double gain, double length, std::size_t pieces) const {
  const double price = price_factor_ * (area_ * price_of_island * static_cast<double>(pieces - 1) +
                                        std::sqrt(area_) * price_of_cut * length);
  // A compromise between the largest gain and the largest gain per cost.
  return gain > price ? gain / std::sqrt(price) : 0;
}

double DivisionSearch::worth(const IslandCells& cells, const Array<Sides>& sides, const WholeIsland& island) const {
  const IslandCells merged = merge(cells, sides).cells;
  const Index count = merged.count();
  if (count < 2 || count > most_pieces) return 0;
  Array<Piece> pieces(count);
  for (Index i = 0; i < count; ++i) pieces[i] = {merged.area[i], merged.map_area[i], merged.faces[i]};
  double length = 0;
  for (const IslandCells::Link& link : merged.links) {
    length += link.length;
    if (link.is_smooth) pieces[link.cells[0]].ends_smoothly = pieces[link.cells[1]].ends_smoothly = true;
  }
  const auto may_be = [&](const Piece& piece) { return may_be_cut_off(piece, island); };
  if (!std::all_of(pieces.begin(), pieces.end(), may_be)) return 0;
  double after = 0;
  for (const Support& piece : merged.support) after += demand(piece);
  return worth(island.demand - after, length, pieces.size());
}

IslandDivision DivisionSearch::find_division(const IslandCells& cells, const WholeIsland& island,
                                             const Array<Complex>& hull, Complex along,
                                             const std::optional<Line>& axis) const {
  IslandDivision best;
  const auto consider = [&](Array<Array<Line>> divisions) {
    if (axis) {
      for (Array<Line>& lines : divisions) add_images(*axis, std::sqrt(area_), lines);
    }
    const auto has_too_many = [](const Array<Line>& lines) { return ssize(lines) > most_lines; };
    divisions.erase(std::remove_if(divisions.begin(), divisions.end(), has_too_many), divisions.end());
    Array<Sides> sides(cells.count(), 0);
    for (Index cell = 0; cell < cells.count(); ++cell) {
      for (std::size_t i = 0; i < divisions.size(); ++i) {
        for (std::size_t k = 0; k < divisions[i].size(); ++k) {
          const bool is_ahead = divisions[i][k].distance(cells.center[cell]) > 0;
          sides[cell] |= static_cast<Sides>(is_ahead) << (most_lines * i + k);
        }
      }
    }
    const MergedCells merged = merge(cells, sides);
    Array<Sides> own(merged.cells.count());
    for (std::size_t i = 0; i < divisions.size(); ++i) {
      for (Index cell = 0; cell < merged.cells.count(); ++cell)
        own[cell] = merged.sides[cell] >> (most_lines * i) & ((1 << most_lines) - 1);
      const double gain = worth(merged.cells, own, island);
      if (gain > best.worth) best = {std::move(divisions[i]), gain};
    }
    checkpoint(operations_a_cell * static_cast<double>(cells.count()));
  };
  Complex center = 0;
  for (Index cell = 0; cell < cells.count(); ++cell) center += cells.area[cell] / island.area * cells.center[cell];
  if (axis) consider({{*axis}});
  for (int i = 0; i < directions; ++i) {
    const Complex normal = along * std::polar(1.0, M_PI * i / directions);
    const Extent extent = extent_along(hull, normal);
    Array<Array<Line>> divisions;
    for (int k = 1; k < division_positions; ++k)
      divisions.push_back({{normal, extent.low.real() + extent.width() * k / division_positions}});
    if (2 * i < directions) {
      const Complex across = normal * Complex(0, 1);
      divisions.push_back({{normal, Line{normal, 0}.distance(center)}, {across, Line{across, 0}.distance(center)}});
    }
    consider(std::move(divisions));
  }
  return best;
}

}  // namespace lsgp
