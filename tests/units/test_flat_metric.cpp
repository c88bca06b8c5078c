// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/flat_metric.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace {

using namespace lsgp;

// A flat square of side - 1 by side - 1 squares, each with one diagonal.
HalfedgeMesh square(Index side) {
  Surface out;
  out.triangles.resize(2 * (side - 1) * (side - 1), 3);
  out.positions.resize(side * side, 3);
  Index f = 0;
  for (Index i = 0; i < side; ++i) {
    for (Index j = 0; j < side; ++j) {
      const Index v = i * side + j;
      out.positions.row(v) << i, j, 0;
      if (i == side - 1 || j == side - 1) continue;
      out.triangles.row(f++) << v, v + side, v + side + 1;
      out.triangles.row(f++) << v, v + side + 1, v + 1;
    }
  }
  std::vector<Finding> findings;
  return std::move(build_topology(out, {}, findings).components.front().mesh);
}

struct Found {
  std::optional<Geometry> metric;
  int steps = 0;
};

// The metric of such a square with this angle defect in its middle, and any sums of angles on its boundary.
Found with_cone(Index side, double defect) {
  const HalfedgeMesh mesh = square(side);
  const Geometry geometry = build_geometry(mesh);
  AngleSums wanted{Eigen::VectorXd::Constant(mesh.vertex_count(), 2 * M_PI), PerVertex<char>(mesh.vertex_count(), 0)};
  for (Index v = 0; v < mesh.vertex_count(); ++v) wanted.is_free[v] = mesh.loop_of_vertex[v] != none;
  wanted.angle[side / 2 * (side + 1)] -= defect;
  Found out;
  out.metric = find_flat_metric({mesh, geometry}, wanted, [&] { ++out.steps; });
  return out;
}

}  // namespace

TEST_CASE("a flat metric has the angle of its cone, and right sums of angles elsewhere") {
  constexpr Index side = 21;
  for (const double defect : {M_PI, -M_PI}) {
    const Found found = with_cone(side, defect);
    REQUIRE(found.metric);
    CHECK(found.steps > 0);
    const HalfedgeMesh mesh = square(side);
    Eigen::VectorXd off = found.metric->angle_defect;
    off[side / 2 * (side + 1)] -= defect;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.loop_of_vertex[v] == none) CHECK(std::abs(off[v]) < 1e-9);
    }
  }
}

TEST_CASE("no step is made where too few would be allowed to find a flat metric") {
  const Found found = with_cone(90, M_PI);  // 15,842 triangles
  CHECK(!found.metric);
  CHECK(found.steps == 0);
}
