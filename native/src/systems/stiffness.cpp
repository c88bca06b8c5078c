// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/nearest_distance.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

Geometry stiffen_around(const MetricMesh& surface, const Array<Index>& cones) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  constexpr double stiffest = 1e4;
  if (cones.empty()) return geometry;
  Eigen::VectorXd weight(mesh.triangle_count());
  const double radius = std::sqrt(geometry.total_area / (M_PI * static_cast<double>(cones.size())));
  NearestDistance nearest(surface);
  nearest.add(cones);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    double mean = 0;
    for (int c = 0; c < 3; ++c) mean += nearest.all()[mesh.triangles(f, c)] / 3;
    const double share = radius / std::max(mean, std::numeric_limits<double>::min());
    weight[f] = std::clamp(share * share, 1.0, stiffest);
  }
  return with_weights(geometry, weight);
}

}  // namespace lsgp
