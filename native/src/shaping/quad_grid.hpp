// SPDX-License-Identifier: GPL-3.0-or-later
// Quads laid out on a grid.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

enum class GridSpacing { mesh, even };

// The vertices, (n), of a surface of quads on a grid, to its scale: as many columns and rows as it has, each as wide as
// its quads on the average, or all alike. most_rows: of the shorter side. Throws SHAPE_IMPOSSIBLE where there are other
// faces, where they are no part of a grid, or where there are more rows.
Eigen::VectorXcd lay_on_grid(const MetricMesh& surface, GridSpacing spacing, Index most_rows);

}  // namespace lsgp
