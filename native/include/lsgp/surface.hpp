// SPDX-License-Identifier: GPL-3.0-or-later
// The input: a triangulated surface, the edges a cut may follow, and the cones.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

namespace lsgp {

using Index = std::int32_t;
using Complex = std::complex<double>;
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;
using VertexPairs = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;

// One (u, v) per triangle corner: row 3 * triangle + corner.
using CornerUv = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

struct Surface {
  Positions positions;               // (n, 3), any unit
  Triangles triangles;               // (m, 3), counter-clockwise seen from outside
  std::optional<VertexPairs> edges;  // (e, 2) edges a cut may follow; absent: every edge of the triangles
  VertexPairs seams;                 // (s, 2) marked edges, with the meaning given by Options::seams
  Eigen::VectorXd importance;        // (n) weights of stretch at vertices, or empty: equal weights
  Eigen::VectorXd cut_costs;         // (e) cost of a cut along each of `edges` per length, or empty: 1
  VertexPairs borders;               // (b, 2) edges where the surface ends, whatever the meaning of seams
  VertexPairs features;              // (f, 2) edges that are to run straight along u or v
  Positions directions;              // (m, 3) desired direction of v at each triangle, weighted by length, or empty
  Eigen::VectorXd scale;             // (n) factor of lengths at vertices, or empty: 1
  bool may_collapse = false;  // triangles may name a vertex twice: no part of the surface, mapped to an edge of it
};

struct Cones {
  std::vector<Index> vertices;                // (k)
  std::vector<std::optional<double>> angles;  // (k) total angle in radians, empty = automatic
};

// Corners with fixed texture coordinates.
struct Pins {
  std::vector<Index> corners;  // (p) 3 * triangle + corner
  CornerUv positions;          // (p, 2)
};

}  // namespace lsgp
