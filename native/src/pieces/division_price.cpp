// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces/division_price.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

DivisionPrice price_of_division(const MetricMesh& surface, const PerHalfedge<double>& factor,
                                const PerHalfedge<char>& ends) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  DivisionPrice out;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (ends[h] && mesh.twin[h] > h) out.cuts += geometry.length[h] * (factor.empty() ? 1 : factor[h]);
  }
  out.cuts /= std::sqrt(geometry.total_area);
  PerTriangle<Index> island;
  PerPart<double> area(label_parts(mesh, ends, island), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[island[f]] += geometry.area[f];
  out.islands = static_cast<Index>(area.size());
  out.slivers = static_cast<Index>(
      std::count_if(area.begin(), area.end(), [&](double own) { return own < sliver * geometry.total_area; }));
  return out;
}

}  // namespace lsgp
