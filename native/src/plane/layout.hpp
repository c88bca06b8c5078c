// SPDX-License-Identifier: GPL-3.0-or-later
// Islands rotated, scaled to one texel density and placed side by side in the unit square.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

#include "base/array.hpp"
#include "lsgp/surface.hpp"
#include "plane/point_lattice.hpp"

namespace lsgp {

struct Island {
  Eigen::VectorXcd position;      // u + iv of its points, at the desired texel density
  std::optional<Complex> turn{};  // none: the rotation with the smallest bounding box
  // The required position of a pinned point; determines only the island's position, not its size or rotation.
  std::optional<std::pair<Eigen::Index, Complex>> pin{};
  Index component = 0;
  std::optional<Complex> axes{};  // the rotation, up to quarters, that aligns its sides with u and v: preferred
};

// The motion of an island as a whole.
struct Similarity {
  Complex turn = 1, shift = 0;
  double divisor = 1;
  Complex move = 0;
  Complex operator()(Complex z) const { return (z * turn + shift) / divisor + move; }
};

// Rotates every island as given or into the smallest box, puts the islands on shelves without overlap and scales all of
// them alike into the unit square; then moves those with a pin to it, together with the other islands of their
// component.
Array<Similarity> arrange(const Array<Island>& islands);

// The unit vector along the longer side of the smallest box around the points.
Complex upright(const Eigen::VectorXcd& position);

// Moves the parts of layouts side by side without rotating or scaling them: each by a lattice point with coordinates
// that are multiples of `step`, into the first quadrant. Those that may lie anywhere and would fill at most half of
// their cells lie beside each other in a box of their own.
struct DividedLayout {
  Eigen::VectorXcd* position;  // u + iv of its points
  Array<Index> part;           // of each of them, 0 .. part_count - 1
  Index part_count;
  bool may_lie_anywhere = false;
};
void arrange_on_lattice(const Array<DividedLayout>& layouts, const PointLattice& lattice, int step);

}  // namespace lsgp
