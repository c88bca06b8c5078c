// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/relocation.hpp"

#include <algorithm>

namespace lsgp {

namespace {

constexpr double least_gain = 0.002;  // of the objective
constexpr int sites_tried = 2;        // of new sites for a cone

// The part of the variance that depends on the site of a curvature, given the slope of the others' variance.
double share(double curvature, double slope, double diagonal) {
  return 2 * curvature * slope + curvature * curvature * diagonal;
}

}  // namespace

bool relocate(const PlacementProblem& problem, const ConeSearch& search, int kept, const Eigen::VectorXd& curvature,
              Array<int>& sites) {
  LogScaleVariance& kernel = problem.kernel;
  Eigen::VectorXd slope = kernel.gradient();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    slope += curvature[static_cast<Eigen::Index>(i)] * *kernel.column(sites[i]);
  }
  double objective = kernel.without_cones() + problem.mean_price(sites);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    objective += curvature[static_cast<Eigen::Index>(i)] * (kernel.gradient()[sites[i]] + slope[sites[i]]);
  }
  bool moved = false;
  for (Eigen::Index i = kept; i < ssize(sites); ++i) {
    const double kappa = curvature[i];
    if (kappa == 0) continue;
    slope -= kappa * *kernel.column(sites[i]);
    Array<int> others = sites;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Array<char> open = search.open_sites(others);
    const int cones = kernel.sites()[sites[i]].cones();
    const auto price = problem.price_among(problem.cone_count(sites));
    for (int tried = 0; tried < sites_tried; ++tried) {
      const auto at = [&](int site) { return share(kappa, slope[site], kernel.diagonal()[site]) + price[site]; };
      const double present = at(sites[i]);
      int best = sites[i];
      for (int site = 0; site < kernel.site_count(); ++site) {
        if (!open[site] || kernel.sites()[site].cones() != cones || !(at(site) < at(best))) continue;
        if (problem.limits.low(site, wider_reach) > kappa || problem.limits.high(site, wider_reach) < kappa) continue;
        best = site;
      }
      const double wanted = present - least_gain * objective;
      if (best == sites[i] || at(best) > wanted) break;
      open[best] = 0;
      if (share(kappa, slope[best], (*kernel.column(best))[best]) + price[best] > wanted) continue;
      objective += at(best) - present;
      sites[i] = best;
      moved = true;
      break;
    }
    slope += kappa * *kernel.column(sites[i]);
  }
  return moved;
}

}  // namespace lsgp
