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

bool relocate(const PlacementProblem& problem, const HalfedgeMesh& mesh, int kept, const Eigen::VectorXd& curvature,
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
  Neighborhoods near(mesh, kernel.sites(), sites, free_rings);
  bool moved = false;
  for (Eigen::Index i = kept; i < ssize(sites); ++i) {
    const double kappa = curvature[i];
    if (kappa == 0) continue;
    slope -= kappa * *kernel.column(sites[i]);
    near.add(sites[i], -1);
    Array<char> tried_in_vain(kernel.site_count(), 0);
    const int cones = kernel.sites()[sites[i]].cones();
    const auto price = problem.price_among(problem.cone_count(sites));
    for (int tried = 0; tried < sites_tried; ++tried) {
      const auto at = [&](int site) { return share(kappa, slope[site], kernel.diagonal()[site]) + price[site]; };
      const double present = at(sites[i]);
      int best = sites[i];
      for (int site = 0; site < kernel.site_count(); ++site) {
        if (!(at(site) < at(best)) || kernel.sites()[site].cones() != cones) continue;
        if (tried_in_vain[site] || !near.is_outside(kernel.sites()[site])) continue;
        if (problem.limits.low(site, wider_reach) > kappa || problem.limits.high(site, wider_reach) < kappa) continue;
        best = site;
      }
      const double wanted = present - least_gain * objective;
      if (best == sites[i] || at(best) > wanted) break;
      tried_in_vain[best] = 1;
      if (share(kappa, slope[best], (*kernel.column(best))[best]) + price[best] > wanted) continue;
      objective += at(best) - present;
      sites[i] = best;
      moved = true;
      break;
    }
    near.add(sites[i], 1);
    slope += kappa * *kernel.column(sites[i]);
  }
  return moved;
}

}  // namespace lsgp
