// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <lsgp/lsgp.hpp>

int main() {
  lsgp::Surface tetrahedron;
  tetrahedron.positions.resize(4, 3);
  tetrahedron.positions << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  tetrahedron.triangles.resize(4, 3);
  tetrahedron.triangles << 0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2;
  lsgp::Cones cones;
  cones.vertices = {0, 1, 2, 3};
  cones.angles.resize(4);
  const lsgp::Result result = lsgp::parameterize(tetrahedron, cones);
  for (const double angle : result.cone_angles) std::printf("%.9f\n", angle);
}
