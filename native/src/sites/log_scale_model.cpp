// SPDX-License-Identifier: GPL-3.0-or-later
#include "sites/log_scale_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lsgp {

namespace {

constexpr double worth_while = 1.3;  // vertices per node, from which on the surface is coarsened
constexpr double nodes_a_site = 2, least_nodes = 4000;
// A spike stretches its surroundings, which the variance has to include.
constexpr int rings_around_sharp = 3;

std::optional<CoarseSurface> coarsened(const LogScale& scale, const Array<Site>& sites) {
  const HalfedgeMesh& mesh = scale.mesh();
  PerVertex<char> kept(mesh.vertex_count(), 0);
  double places = 0;
  for (const Site& site : sites) {
    kept[site.vertex] = 1;
    if (site.mirrored != none) kept[site.mirrored] = 1;
    places += site.cones();
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (std::abs(scale.geometry().angle_defect[v]) >= sharp_defect) mark_rings(mesh, v, rings_around_sharp, kept);
  }
  const double nodes = std::max(nodes_a_site * places, least_nodes);
  if (mesh.vertex_count() < worth_while * nodes) return std::nullopt;
  return CoarseSurface(scale.surface(), kept, static_cast<Index>(nodes));
}

}  // namespace

LogScaleModel::LogScaleModel(LogScale& scale, const Array<Site>& sites)
    : scale_(scale),
      coarse_(coarsened(scale, sites)),
      weight_(scale.geometry().vertex_area / scale.geometry().total_area),
      elsewhere_(scale.border().curvature - scale.geometry().angle_defect) {
  if (!coarse_) return;
  weight_ = coarse_->at_nodes(std::move(weight_));
  elsewhere_ = coarse_->at_nodes(std::move(elsewhere_));
  coarse_scale_.emplace(coarse_->surface(), coarse_->at_nodes(scale.border()));
}

Eigen::MatrixXd LogScaleModel::solve_columns(const Eigen::MatrixXd& right_sides) const {
  return scale().solve_columns(right_sides);
}

Eigen::VectorXd LogScaleModel::at_vertices(Eigen::VectorXd values) const {
  if (!coarse_) return values;
  return coarse_->at_vertices(values);
}

}  // namespace lsgp
