// SPDX-License-Identifier: GPL-3.0-or-later
#include "sites/log_scale_variance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdint>

#include "base/memory.hpp"

namespace lsgp {

namespace {

constexpr int solved_at_once = 16;
constexpr std::size_t most_kept = 16 << 20;  // numbers, in columns of H
constexpr int calibrations = 8;              // exact entries of the diagonal that its estimate is compared with

// The same signs on every machine.
class Signs {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return state_ >> 63 ? 1.0 : -1.0;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

LogScaleVariance::LogScaleVariance(Borrowed<const LogScaleModel> model, Array<Site> sites, int probes,
                                   ProgressMonitor& monitor)
    : model_(model), elsewhere_(model_.elsewhere()), weight_(model_.weight()), sites_(std::move(sites)) {
  // The memory for the probes and for some columns of the model at a time.
  require_matrix_memory(static_cast<double>(site_count()), 2.0 * probes);
  require_matrix_memory(static_cast<double>(weight_.size()), 6.0 * solved_at_once);
  const Eigen::MatrixXd y = caused_by(elsewhere_);
  without_cones_ = weight_.dot(y.col(0).cwiseAbs2());
  gradient_ = at_sites(transposed(weight_.asDiagonal() * y));
  monitor.advance(0.05);
  estimate_diagonal(std::min(probes, site_count()), monitor);
}

Eigen::MatrixXd LogScaleVariance::impulses(const Array<int>& sites) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(weight_.size(), static_cast<Eigen::Index>(sites.size()));
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Site& site = sites_[sites[i]];
    out(model_.node(site.vertex), static_cast<Eigen::Index>(i)) = 1.0 / site.cones();
    if (site.mirrored != none) out(model_.node(site.mirrored), static_cast<Eigen::Index>(i)) = 0.5;
  }
  return out;
}

Eigen::VectorXd LogScaleVariance::at_nodes(const Array<int>& sites, const Eigen::VectorXd& curvature) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(weight_.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Site& site = sites_[sites[i]];
    const double share = curvature[static_cast<Eigen::Index>(i)] / site.cones();
    out[model_.node(site.vertex)] += share;
    if (site.mirrored != none) out[model_.node(site.mirrored)] += share;
  }
  return out;
}

Eigen::MatrixXd LogScaleVariance::caused_by(Eigen::MatrixXd curvature) const {
  // If Gauss-Bonnet has to hold, curvature is compensated evenly over the area.
  if (model_.balanced()) curvature -= weight_ * curvature.colwise().sum().eval();
  Eigen::MatrixXd y = model_.solve_columns(curvature);
  y.rowwise() -= (weight_.transpose() * y).eval();
  return y;
}

Eigen::MatrixXd LogScaleVariance::transposed(Eigen::MatrixXd values) const {
  values -= weight_ * values.colwise().sum().eval();
  Eigen::MatrixXd out = model_.solve_columns(values);
  if (model_.balanced()) out.rowwise() -= (weight_.transpose() * out).eval();
  return out;
}

Eigen::MatrixXd LogScaleVariance::at_sites(const Eigen::MatrixXd& values) const {
  Eigen::MatrixXd out(site_count(), values.cols());
  for (int i = 0; i < site_count(); ++i) {
    out.row(i) = values.row(model_.node(sites_[i].vertex));
    if (sites_[i].mirrored != none) out.row(i) = (out.row(i) + values.row(model_.node(sites_[i].mirrored))) / 2;
  }
  return out;
}

LogScaleVariance::Column LogScaleVariance::column(int site) {
  const auto known = columns_.find(site);
  if (known != columns_.end()) return known->second;
  const Eigen::MatrixXd y = caused_by(impulses({site}));
  const Column out = std::make_shared<const Eigen::VectorXd>(at_sites(transposed(weight_.asDiagonal() * y)));
  diagonal_[site] = (*out)[site];
  if ((columns_.size() + 1) * sites_.size() <= most_kept) columns_.emplace(site, out);
  return out;
}

Eigen::MatrixXd LogScaleVariance::entries(const Array<int>& rows, const Array<int>& columns) const {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index begin = 0; begin < ssize(columns); begin += solved_at_once) {
    const Eigen::Index end = std::min(begin + solved_at_once, ssize(columns));
    const Eigen::MatrixXd y = caused_by(impulses({columns.begin() + begin, columns.begin() + end}));
    const Eigen::MatrixXd whole = at_sites(transposed(weight_.asDiagonal() * y));
    for (Eigen::Index i = 0; i < ssize(rows); ++i) out.row(i).segment(begin, whole.cols()) = whole.row(rows[i]);
  }
  return out;
}

Eigen::VectorXd LogScaleVariance::product(const Array<int>& sites, const Eigen::VectorXd& curvature) const {
  const Eigen::MatrixXd y = caused_by(at_nodes(sites, curvature));
  return at_sites(transposed(weight_.asDiagonal() * y));
}

Eigen::VectorXd LogScaleVariance::log_scale(const Array<int>& sites, const Eigen::VectorXd& curvature) const {
  return model_.at_vertices(caused_by(elsewhere_ + at_nodes(sites, curvature)));
}

// H is nearly of low rank: H = Y (Omega' Y)^-1 Y' with Y = H Omega for random Omega, and the missing part of the
// diagonal is nearly constant (Gittens and Mahoney 2016).
void LogScaleVariance::estimate_diagonal(int probes, ProgressMonitor& monitor) {
  const int count = site_count();
  diagonal_ = Eigen::VectorXd::Zero(count);
  if (count == 0) return;
  Eigen::MatrixXd omega(count, probes), image(count, probes);
  Signs signs;
  for (Eigen::Index j = 0; j < probes; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) omega(i, j) = signs.next();
  }
  for (int begin = 0; begin < probes; begin += solved_at_once) {
    const int width = std::min(solved_at_once, probes - begin);
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(weight_.size(), width);
    for (int i = 0; i < count; ++i) {
      const auto share = omega.row(i).segment(begin, width) / sites_[i].cones();
      curvature.row(model_.node(sites_[i].vertex)) += share;
      if (sites_[i].mirrored != none) curvature.row(model_.node(sites_[i].mirrored)) += share;
    }
    const Eigen::MatrixXd y = caused_by(std::move(curvature));
    image.middleCols(begin, width) = at_sites(transposed(weight_.asDiagonal() * y));
    monitor.advance(0.05 + 0.85 * (begin + width) / probes);
  }
  Eigen::MatrixXd core = omega.transpose() * image;
  core = ((core + core.transpose()) / 2).eval();
  core.diagonal().array() += 1e-12 * core.trace() / probes;
  const Eigen::LLT<Eigen::MatrixXd> factor(core);
  if (factor.info() == Eigen::Success) {
    const Eigen::MatrixXd rows = factor.matrixL().solve(image.transpose());
    diagonal_ = rows.colwise().squaredNorm();
  }
  Array<int> chosen;
  for (int i = 0; i < calibrations; ++i) {
    const int site = static_cast<int>(static_cast<std::int64_t>(i) * count / calibrations);
    if (chosen.empty() || chosen.back() != site) chosen.push_back(site);
  }
  const Eigen::MatrixXd y = caused_by(impulses(chosen));
  Eigen::VectorXd missing(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i);
    missing[column] = weight_.dot(y.col(column).cwiseAbs2()) - diagonal_[chosen[i]];
  }
  diagonal_error_ = std::max(missing.mean(), 0.0);
  diagonal_.array() += diagonal_error_;
  monitor.advance(1);
}

}  // namespace lsgp
