// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/batch_placement.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "solvers/dense_cholesky.hpp"

namespace lsgp {

namespace {

constexpr int batches_to_double = 6;     // in larger batches cones interfere with each other
constexpr int exchanged_share = 10;      // one in so many
constexpr double worth_a_round = 0.998;  // of the variance: less is not worth a further round
constexpr double blocks = 6;             // of H in memory: the fit's form, its factor, and a copy to return to
constexpr std::size_t probes = 8;        // sites at which the spread is measured

// The rings that can be left free around each cone if there are so many.
int rings_for(int cones, Index vertices) {
  int rings = free_rings;
  const auto vertices_within = [&] { return 1.0 + 3 * rings * (rings + 1); };  // where all have six neighbors
  while (rings > 0 && cones * vertices_within() > vertices) --rings;
  return rings;
}

}  // namespace

void BatchPlacement::add(const Array<int>& sites) {
  const Eigen::Index before = static_cast<Eigen::Index>(state_.sites.size());
  const Eigen::Index added = static_cast<Eigen::Index>(sites.size());
  require_matrix_memory(static_cast<double>(before + added), blocks * static_cast<double>(before + added),
                        GrowsWith::conditions);
  state_.sites.insert(state_.sites.end(), sites.begin(), sites.end());
  const Eigen::MatrixXd columns = problem_.kernel.entries(state_.sites, sites);
  state_.hessian.conservativeResize(before + added, before + added);
  state_.hessian.rightCols(added) = columns;
  state_.hessian.bottomLeftCorner(added, before) = columns.topRows(before).transpose();
  state_.fit.curvature.conservativeResize(before + added);
  state_.fit.curvature.tail(added).setZero();
  state_.fit = fit_curvature(problem_, state_.sites, reach_, state_.hessian, std::move(state_.fit.curvature));
}

void BatchPlacement::remove(const Array<int>& places) {
  Array<char> is_removed(state_.sites.size(), 0);
  for (const int place : places) is_removed[place] = 1;
  Array<int> left, sites;
  for (std::size_t i = 0; i < is_removed.size(); ++i) {
    if (is_removed[i]) continue;
    left.push_back(static_cast<int>(i));
    sites.push_back(state_.sites[i]);
  }
  state_.sites = std::move(sites);
  state_.hessian = state_.hessian(left, left).eval();
  state_.fit = fit_curvature(problem_, state_.sites, reach_, state_.hessian, state_.fit.curvature(left).eval());
}

NearestDistance BatchPlacement::distances() const {
  NearestDistance out({mesh_, geometry_});
  for (const int site : state_.sites) {
    for (const Index v : {problem_.kernel.sites()[site].vertex, problem_.kernel.sites()[site].mirrored}) {
      if (v != none) out.add({v});
    }
  }
  return out;
}

// The decrease of half the variance with curvature at each site, (sites), under a fixed sum.
Eigen::VectorXd BatchPlacement::slopes() const {
  Eigen::VectorXd slope = -problem_.kernel.gradient() - problem_.kernel.product(state_.sites, curvature());
  if (problem_.balanced) slope.array() -= mean_slope(state_.fit, state_.sites, slope);
  return slope;
}

// The increase of the variance by a unit of curvature at a site, after the response of the cones, grows with the square
// of the distance to the nearest of them, like the deflection of a thin plate supported there. Returns the factor, the
// median over some sites.
double BatchPlacement::spread_of(const Array<int>& sites, const Eigen::VectorXd& far) const {
  const LogScaleVariance& kernel = problem_.kernel;
  Array<int> rows = state_.sites;
  rows.insert(rows.end(), sites.begin(), sites.end());
  const Eigen::MatrixXd columns = kernel.entries(rows, sites);
  const Eigen::Index k = state_.hessian.rows();
  const Eigen::MatrixXd response = DenseCholesky<double>(with_ridge(state_.hessian)).solve(columns.topRows(k));
  Array<double> factors;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double left = columns(k + i, i) - response.col(i).dot(columns.col(i).head(k));
    const double distance = far[kernel.sites()[sites[static_cast<std::size_t>(i)]].vertex];
    factors.push_back(std::max(left, 0.0) / (distance * distance));
  }
  std::nth_element(factors.begin(), factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2), factors.end());
  return factors[factors.size() / 2];
}

// Sites with the largest gain less their price, each nearer to an existing cone than to another of these sites.
Array<int> BatchPlacement::choose(int cones, double spread, int rings) const {
  const LogScaleVariance& kernel = problem_.kernel;
  const Array<char> open = search_.open_sites(state_.sites, rings);
  const Eigen::VectorXd slope = slopes();
  const auto price = problem_.price_among(cone_count() + cones);
  NearestDistance nearest = distances();
  const Eigen::VectorXd before = nearest.all();
  Array<std::pair<double, int>> gains;
  for (int i = 0; i < kernel.site_count(); ++i) {
    if (!open[i]) continue;
    const double distance = before[kernel.sites()[i].vertex];
    const double d = std::clamp(spread * distance * distance, 1e-12 * kernel.diagonal().mean(), kernel.diagonal()[i]);
    const double t = std::clamp(slope[i] / d, problem_.limits.low(i, reach_), problem_.limits.high(i, reach_));
    const double gain = search_.preference(i) * (2 * t * slope[i] - t * t * d) - price[i];
    gains.emplace_back(-gain / kernel.sites()[i].cones(), i);
  }
  std::sort(gains.begin(), gains.end());
  Array<int> chosen;
  for (const auto& [gain, site] : gains) {
    const Site& at = kernel.sites()[site];
    if (at.cones() > cones || nearest.all()[at.vertex] < before[at.vertex]) continue;
    chosen.push_back(site);
    cones -= at.cones();
    if (cones == 0) break;
    nearest.add({at.vertex});
    if (at.mirrored != none) nearest.add({at.mirrored});
  }
  return chosen;
}

void BatchPlacement::grow(int cones) {
  const int rings = rings_for(cones, mesh_.vertex_count());
  std::optional<double> spread;
  while (cone_count() < cones) {
    if (!spread) {
      const Array<char> open = search_.open_sites(state_.sites, rings);
      Array<int> all, some;
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (open[i]) all.push_back(static_cast<int>(i));
      }
      if (all.empty()) return;
      const std::size_t count = std::min(probes, all.size());
      for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
      spread = spread_of(some, distances().all());
    }
    const int present = cone_count();
    const int batch = std::min(cones - present, std::max(2, present / batches_to_double));
    const Array<int> chosen = choose(batch, *spread, rings);
    if (chosen.empty()) return;
    add(chosen);
    monitor_.tick();
  }
}

// The increase of the variance, to first order, without each cone.
Array<int> BatchPlacement::least_needed(int count) const {
  const Eigen::Index k = state_.hessian.rows();
  const DenseCholesky<double> factor(with_ridge(state_.hessian));
  Eigen::VectorXd inverse(k);
  constexpr Eigen::Index columns_at_once = 64;
  for (Eigen::Index begin = 0; begin < k; begin += columns_at_once) {
    const Eigen::Index width = std::min(columns_at_once, k - begin);
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(k, width);
    units.middleRows(begin, width).setIdentity();
    inverse.segment(begin, width) = factor.solve(units).middleRows(begin, width).diagonal();
    checkpoint(static_cast<double>(2 * k * k * width));
  }
  Array<int> places = search_.by_need(state_.sites, curvature().cwiseAbs2().cwiseQuotient(inverse));
  places.resize(std::min(places.size(), static_cast<std::size_t>(count)));
  return places;
}

void BatchPlacement::exchange(int rounds) {
  const int exchanged = static_cast<int>(state_.sites.size()) / exchanged_share;
  for (int round = 0; exchanged > 0 && round < rounds; ++round) {
    const int cones = cone_count();
    const State before = state_;
    const double objective_before = objective();
    remove(least_needed(exchanged));
    grow(cones);
    if (cone_count() == cones && objective() < worth_a_round * objective_before) continue;
    if (!(cone_count() == cones && objective() < objective_before)) state_ = before;
    return;
  }
}

}  // namespace lsgp
