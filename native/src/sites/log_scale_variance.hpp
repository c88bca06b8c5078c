// SPDX-License-Identifier: GPL-3.0-or-later
// The area-weighted variance of the log scale as a quadratic form in the curvatures at the sites where cones may go:
// J(x) = J_0 + 2 h . x + x . H x, for all sites at once and on one factorization.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "base/progress_monitor.hpp"
#include "sites/cone_sites.hpp"
#include "sites/log_scale_model.hpp"

namespace lsgp {

class LogScaleVariance {
 public:
  // probes: random curvatures from which the diagonal of H is estimated (Nystrom), to about 1 % with 48 of them.
  LogScaleVariance(Borrowed<const LogScaleModel> model, Array<Site> sites, int probes, ProgressMonitor& monitor);

  const Array<Site>& sites() const { return sites_; }
  int site_count() const { return static_cast<int>(sites_.size()); }
  double without_cones() const { return without_cones_; }        // J_0
  const Eigen::VectorXd& gradient() const { return gradient_; }  // (sites) h
  const Eigen::VectorXd& diagonal() const { return diagonal_; }  // (sites) of H, estimated until its column is known
  double diagonal_error() const { return diagonal_error_; }      // how far off it may be
  using Column = std::shared_ptr<const Eigen::VectorXd>;         // (sites)
  Column column(int site);                                       // of H, exact
  // Some rows and columns of H, exact: two back-substitutions a column, of which only these rows are kept.
  Eigen::MatrixXd entries(const Array<int>& rows, const Array<int>& columns) const;
  // H times curvatures at some sites, (sites): two back-substitutions.
  Eigen::VectorXd product(const Array<int>& sites, const Eigen::VectorXd& curvature) const;
  bool knows(int site) const { return columns_.count(site) > 0; }
  // The log scale, (n) of mean 0, with curvatures at some sites.
  Eigen::VectorXd log_scale(const Array<int>& sites, const Eigen::VectorXd& curvature) const;

 private:
  Eigen::MatrixXd impulses(const Array<int>& sites) const;
  Eigen::VectorXd at_nodes(const Array<int>& sites, const Eigen::VectorXd& curvature) const;
  // The log scale, of mean 0, that curvatures (nodes, k) cause, and the transpose of this.
  Eigen::MatrixXd caused_by(Eigen::MatrixXd curvature) const;
  Eigen::MatrixXd transposed(Eigen::MatrixXd values) const;
  Eigen::MatrixXd at_sites(const Eigen::MatrixXd& values) const;  // (sites, k)
  void estimate_diagonal(int probes, ProgressMonitor& monitor);

  const LogScaleModel& model_;
  const Eigen::VectorXd& elsewhere_;  // (nodes) of the model, and its weight
  const Eigen::VectorXd& weight_;
  Array<Site> sites_;
  double without_cones_ = 0;
  Eigen::VectorXd gradient_, diagonal_;
  double diagonal_error_ = 0;
  std::map<int, Column> columns_;  // that are kept
};

}  // namespace lsgp
