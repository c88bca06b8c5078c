// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "lsgp/surface.hpp"

namespace lsgp {

// Rings of quads, one after the other, as of pipes, ropes, horns and walls of revolution.
struct Tubes {
  // Strips of handles, and of what is closed on itself, are stretched by no more, as much as placed cones may leave.
  static constexpr double most_l2 = 1.05;
  VertexPairs borders;           // (b, 2) edges at which they end, for `Surface::borders`
  std::vector<Index> triangles;  // of tubes, in order
};

}  // namespace lsgp
