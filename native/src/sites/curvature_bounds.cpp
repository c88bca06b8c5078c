// SPDX-License-Identifier: GPL-3.0-or-later
#include "sites/curvature_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr double largest_share = 100 * M_PI / 180;   // of a triangle in the angle of its cone
constexpr double possible_share = 170 * M_PI / 180;  // if more cones are not available
constexpr double smallest_angle = 0.35 * 2 * M_PI;

}  // namespace

CurvatureBounds::CurvatureBounds(const MetricMesh& surface, const Array<Site>& sites, const Eigen::VectorXd& given)
    : defect_(sites.size()),
      least_defect_(sites.size()),
      flat_(sites.size()),
      triangles_(sites.size()),
      given_(sites.size()),
      cones_(sites.size()) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const Eigen::Index i = static_cast<Eigen::Index>(s);
    const Index v = sites[s].vertex, mirrored = sites[s].mirrored == none ? v : sites[s].mirrored;
    defect_[i] = std::max(geometry.angle_defect[v], geometry.angle_defect[mirrored]);
    least_defect_[i] = std::min(geometry.angle_defect[v], geometry.angle_defect[mirrored]);
    flat_[i] = mesh.flat_angle(v);
    triangles_[i] = std::min(valence(mesh, v), valence(mesh, mirrored));
    given_[i] = given[v];
    cones_[i] = sites[s].cones();
  }
}

double CurvatureBounds::low(int site, double reach) const {
  if (!std::isnan(given_[site])) return cones_[site] * given_[site];
  const double share = std::min(largest_share * std::max(1.0, reach), possible_share);
  const double widest = flat_[site] - share * triangles_[site];
  return cones_[site] * std::min(std::max(defect_[site] - reach * M_PI, widest), flat_[site]);
}

double CurvatureBounds::high(int site, double reach) const {
  if (!std::isnan(given_[site])) return cones_[site] * given_[site];
  const double widest = flat_[site] - smallest_angle / std::max(1.0, reach);
  return std::max(low(site, reach), cones_[site] * std::min(least_defect_[site] + reach * M_PI, widest));
}

}  // namespace lsgp
