// SPDX-License-Identifier: GPL-3.0-or-later
// The best division of an island, with which all islands fill a square better.
#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "plane/convex_hull.hpp"

namespace lsgp {

// The square that the islands of a map share with all others.
struct SharedSquare {
  double area;   // of all islands, on the surface
  double scale;  // of the map to the surface
  Compactness filling;
};

constexpr int division_positions = 12;  // that are tried across an island

struct Line {
  Complex normal;  // of length 1
  double offset;
  // Above 0 on the side that the normal points to.
  double distance(Complex z) const { return std::real(std::conj(normal) * z) - offset; }
  Line reversed() const { return {-normal, -offset}; }
  // The mirror image of this line, with its normal.
  Line mirrored_at(const Line& axis) const {
    const Complex image = -axis.normal * axis.normal * std::conj(normal);
    return {image, offset + 2 * axis.offset * std::real(std::conj(image) * axis.normal)};
  }
};

// How far points reach along evenly spread directions, from which the sizes of their hull follow: that of a union is
// the larger of both along each.
class Support {
 public:
  static constexpr std::size_t turns = 45;  // in a quarter

  Support() { along_.fill(-std::numeric_limits<double>::infinity()); }
  explicit Support(const Array<Complex>& points);

  void add(const Support& other) {
    for (std::size_t i = 0; i < along_.size(); ++i) along_[i] = std::max(along_[i], other.along_[i]);
  }
  // Of the least polygon with sides across these directions that contains the points.
  double hull_area() const;
  // Of the box that is turned by so many of the turns.
  double width(std::size_t turn) const { return along_[turn] + along_[turn + 2 * turns]; }
  double height(std::size_t turn) const { return along_[turn + turns] + along_[turn + 3 * turns]; }

 private:
  std::array<double, 4 * turns> along_;
};

// A way to divide an island: by a line, or by two that cross.
struct IslandDivision {
  Array<Line> lines;
  double worth = 0;
};

// The faces of an island merged into cells, to try divisions quickly.
struct IslandCells {
  struct Link {
    Index cells[2];
    double length;
    bool is_smooth;  // where the surface hardly bends, or bends as round shapes do
  };
  Array<Complex> center;
  Array<double> area, map_area;
  Array<Index> faces;  // their number
  Array<Support> support;
  Array<Link> links;
  Index count() const { return static_cast<Index>(area.size()); }
};

// An island before it is divided.
struct WholeIsland {
  double area = 0;
  double demand = 0;      // of the square
  bool is_long = false;   // it reaches so far that it blocks room for others
  double unevenness = 0;  // root mean square of the logarithm of its faces' areas in the map relative to their own
};

// A part of a divided island.
struct Piece {
  double area = 0;
  double map_area = 0;  // on the scale of the surface
  Index faces = 0;
  bool ends_smoothly = false;  // at some of its cuts
};

// Weighs the area of the square that divisions save against their cost.
class DivisionSearch {
 public:
  // On which sides of all lines that are tried together a cell lies, one bit each.
  using Sides = std::uint32_t;

  explicit DivisionSearch(const SharedSquare& square);

  // An island of this area, its unevenness left out.
  WholeIsland describe(double area, const Support& support) const;
  // The area of the square that an island occupies.
  double demand(const Support& support) const { return describe(0, support).demand; }

  // Whether a piece of an island is large enough, not a scrap of few faces, and has about the texel density of all,
  // which matters the less, the more the island leaves empty of what it occupies. Pieces of few faces may be as small
  // as others only on hard surfaces, where all their cuts follow sharp edges, and on narrow islands. Of long islands
  // also smaller pieces may be cut off: a thin tail keeps everything else small.
  bool may_be_cut_off(const Piece& piece, const WholeIsland& island) const;

  // Into how many equal pieces a strip of this length is divided: as few as leave none of them long, and at most 8.
  Index pieces_of_strip(double length) const;

  // The least saving that can be worth a division.
  double least_gain() const;

  // The worth of a division into this many pieces by cuts of this length; 0 if the gain does not exceed the price.
  double worth(double gain, double length, std::size_t pieces) const;

  // The best division of an island with this hull.  along: a side of its smallest box.  axis: if the island mirrors
  // itself there, so does the division, and it may run along the axis.
  IslandDivision find_division(const IslandCells& cells, const WholeIsland& island, const Array<Complex>& hull,
                               Complex along, const std::optional<Line>& axis) const;

 private:
  double worth(const IslandCells& cells, const Array<Sides>& sides, const WholeIsland& island) const;

  const double area_, price_factor_;
};

}  // namespace lsgp
