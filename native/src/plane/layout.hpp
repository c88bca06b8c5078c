// SPDX-License-Identifier: GPL-3.0-or-later
// Islands turned, scaled to one texel density and placed side by side in the unit square.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "plane/point_lattice.hpp"

namespace lsgp {

struct Island {
  Eigen::VectorXcd position;      // u + iv of its points, at the texel density it is to have
  std::optional<Complex> turn{};  // none: the one that makes its bounding box smallest
  // Where a pinned point has to end up; only the place of the island follows, not its size or turn.
  std::optional<std::pair<Eigen::Index, Complex>> pin{};
  Index component = 0;
};

// How an island is moved as a whole.
struct Similarity {
  Complex turn = 1, shift = 0;
  double divisor = 1;
  Complex move = 0;
  Complex operator()(Complex z) const { return (z * turn + shift) / divisor + move; }
};

// Turns every island, puts the islands on shelves without overlap and scales all
// of them alike into the unit square; then moves those with a pin to it, and the others of their component along.
Array<Similarity> arrange(const Array<Island>& islands);

// The unit vector along the longer side of the smallest box around the points.
Complex upright(const Eigen::VectorXcd& position);

// Moves the parts of layouts side by side without turning or scaling them: each by a lattice point, its coordinates
// multiples of `step`, into the first quadrant.
struct DividedLayout {
  Eigen::VectorXcd* position;  // u + iv of its points
  Array<Index> part;           // of each of them, 0 .. part_count - 1
  Index part_count;
};
void arrange_on_lattice(const Array<DividedLayout>& layouts, const PointLattice& lattice, int step);

}  // namespace lsgp
