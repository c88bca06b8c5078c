// SPDX-License-Identifier: GPL-3.0-or-later
// Cones at some sites with the curvatures that minimize the variance of the log scale, the gain of another cone, and
// the cost of removing one.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "sites/curvature_bounds.hpp"
#include "sites/log_scale_variance.hpp"

namespace lsgp {

// Data shared by all sets on one component.
struct PlacementProblem {
  LogScaleVariance& kernel;
  const CurvatureBounds& limits;
  bool balanced;        // Gauss-Bonnet has to hold
  double required_sum;  // then of all curvatures
  // (sites) A set is chosen for its variance and the mean of this over its cones.
  Eigen::VectorXd price;

  int cone_count(const Array<int>& sites) const;
  // The sites' shares in that mean, (all sites), in a set of so many cones.
  auto price_among(int cones) const { return price / cones; }
  double mean_price(const Array<int>& sites) const;
};

// The curvatures of cones at some sites that minimize the variance, and their bounds.
struct CurvatureFit {
  Eigen::VectorXd low, high, curvature;  // (k)
  double used_reach = 0;                 // of the bounds: widened where Gauss-Bonnet wants more
  double variance = 0;

  bool feasible() const { return used_reach <= widest_reach; }
  Array<int> free_places() const;  // whose curvatures are at no bound
};

// hessian: (k, k) the sites' block of H.  start: (k) as they were.
CurvatureFit fit_curvature(const PlacementProblem& problem, const Array<int>& sites, double reach,
                           const Eigen::MatrixXd& hessian, Eigen::VectorXd start);

// The multiplier of Gauss-Bonnet, subtracted from all slopes, (all sites): their mean over free curvatures.
double mean_slope(const CurvatureFit& fit, const Array<int>& sites, const Eigen::VectorXd& slope);

// A symmetric block of H, with its diagonal raised so that cones with nearly equal effects are distinguishable.
Eigen::MatrixXd with_ridge(const Eigen::MatrixXd& hessian);

class ConeSet {
 public:
  ConeSet(const PlacementProblem& problem, double reach) : problem_(&problem), reach_(reach) { fit(); }

  void add(int site) { add(Array<int>{site}); }
  void add(const Array<int>& sites);  // one fit, and two back-substitutions a site that is new
  void remove(int place);

  const Array<int>& sites() const { return sites_; }
  const Eigen::VectorXd& curvature() const { return fit_.curvature; }  // of the sites, both of two cones together
  int cone_count() const { return problem_->cone_count(sites_); }
  double variance() const { return fit_.variance; }
  // The bounds can be widened enough to satisfy Gauss-Bonnet.
  bool feasible() const { return fit_.feasible(); }

  // The decrease of the variance with a cone at each site, (sites): exact, up to the estimate of the diagonal, if no
  // other curvature reaches its bound (orthogonal matching pursuit).
  Eigen::VectorXd gains() const { return gains(explained()); }
  // The same with the explained part of the diagonal of H, (sites), given.
  Eigen::VectorXd gains(const Eigen::VectorXd& explained) const;

  // The part of the diagonal of H explained by all cones: they partly compensate curvature that is added anywhere.
  struct Explained {
    Eigen::VectorXd by_all;     // (sites)
    Array<int> free;            // places whose curvatures are at no bound
    Eigen::MatrixXd responses;  // (sites, free) the negated responses to these
    Eigen::VectorXd inverse;    // (free) diagonal of the inverse that it is computed from
    // The part explained by the others without one.
    Eigen::VectorXd without(int place) const;
  };
  Explained explain() const;
  Eigen::VectorXd explained() const;  // `by_all` alone, which takes less memory

  // The increase of the variance, to first order, without each of the cones, (k).
  Eigen::VectorXd losses() const;

 private:
  void fit();
  Array<int> places_that_respond() const;
  Eigen::MatrixXd inverse_over(const Array<int>& free) const;
  Eigen::VectorXd first_gains() const;

  const PlacementProblem* problem_;
  double reach_;
  Array<int> sites_;
  Array<LogScaleVariance::Column> columns_;  // (k), which copies share
  CurvatureFit fit_;
};

}  // namespace lsgp
