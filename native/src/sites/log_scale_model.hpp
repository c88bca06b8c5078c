// SPDX-License-Identifier: GPL-3.0-or-later
// The log scale caused by curvatures, for the choice of cones: on the surface itself or, if that is large, on a coarse
// triangulation of it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "mesh/coarse_surface.hpp"
#include "prescription/log_scale.hpp"
#include "sites/cone_sites.hpp"

namespace lsgp {

// L y = kappa - K at its nodes, as in LogScale.
class LogScaleModel {
 public:
  // sites: where cones may be placed; all of them become nodes.
  LogScaleModel(LogScale& scale, const Array<Site>& sites);
  LogScaleModel(const LogScaleModel&) = delete;
  LogScaleModel& operator=(const LogScaleModel&) = delete;

  // That of the surface itself, or one whose vertices are the nodes.
  LogScale& scale() { return coarse_scale_ ? *coarse_scale_ : scale_; }
  const LogScale& scale() const { return coarse_scale_ ? *coarse_scale_ : scale_; }
  bool balanced() const { return scale_.balanced(); }
  Index node_count() const { return static_cast<Index>(weight_.size()); }
  Index node(Index vertex) const { return coarse_ ? coarse_->node(vertex) : vertex; }
  const Eigen::VectorXd& weight() const { return weight_; }        // (nodes) share of the area
  const Eigen::VectorXd& elsewhere() const { return elsewhere_; }  // (nodes) curvature without cones less angle defects
  // Solves L y = right side, (nodes, k), up to a constant when balanced.
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right_sides) const;
  Eigen::VectorXd at_vertices(Eigen::VectorXd values) const;  // (n) of (nodes)

 private:
  LogScale& scale_;
  std::optional<CoarseSurface> coarse_;
  std::optional<LogScale> coarse_scale_;
  Eigen::VectorXd weight_, elsewhere_;
};

}  // namespace lsgp
