// SPDX-License-Identifier: GPL-3.0-or-later
// The best division of an island, with which all islands fill a square better.
#pragma once

#include <complex>

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

// As a fraction of the area of all islands: smaller pieces are not cut off.
constexpr double least_piece = 0.01;
constexpr int division_positions = 12;  // that are tried across an island

struct Line {
  Complex normal;  // of length 1
  double offset;
  // Above 0 on the side that the normal points to.
  double distance(Complex z) const { return std::real(std::conj(normal) * z) - offset; }
};

// A way to divide an island: by a line, or by two that cross.
struct IslandDivision {
  Array<Line> lines;
  double worth = 0;
};

// The faces of an island taken together to cells, to try divisions quickly.
struct IslandCells {
  struct Link {
    Index cells[2];
    double length;
  };
  Array<Complex> center;
  Array<double> area;
  Array<Array<Complex>> hull;
  Array<Link> links;
  Index count() const { return static_cast<Index>(area.size()); }
};

// Weighs the area of the square that divisions save against their cost.
class DivisionSearch {
 public:
  explicit DivisionSearch(const SharedSquare& square);

  // The area of the square that an island with this hull occupies.
  double demand(const Array<Complex>& hull) const;

  // The least saving that can be worth a division.
  double least_gain() const;

  // The worth of a division into this many pieces by cuts of this length; 0 if the gain does not exceed the price.
  double worth(double gain, double length, std::size_t pieces) const;

  // The best division of an island.  along: a side of its smallest box.
  IslandDivision find_division(const IslandCells& cells, const Array<Complex>& hull, Complex along) const;

 private:
  double worth(const IslandCells& cells, const Array<Index>& class_of, double demand_before) const;

  const double area_, price_factor_;
};

}  // namespace lsgp
