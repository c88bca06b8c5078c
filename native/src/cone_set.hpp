// SPDX-License-Identifier: GPL-3.0-or-later
// Cones at some sites with the curvatures that make the variance of the log scale least, and what another one would
// gain or the loss of one cost.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "site_limits.hpp"
#include "variance_kernel.hpp"

namespace lsgp {

// What all sets on one component have in common.
struct PlacementProblem {
  VarianceKernel& kernel;
  const SiteLimits& limits;
  bool balanced;        // Gauss-Bonnet has to hold
  double required_sum;  // then of all curvatures
};

class ConeSet {
 public:
  ConeSet(const PlacementProblem& problem, double reach) : problem_(&problem), reach_(reach) {
    columns_.resize(problem.kernel.site_count(), 0);
    fit();
  }

  void add(int site);  // two back-substitutions where the site is new
  void remove(int place);

  const std::vector<int>& sites() const { return sites_; }
  const Eigen::VectorXd& curvature() const { return curvature_; }  // of the sites, both of two cones together
  int cone_count() const;
  double variance() const { return variance_; }
  // The bounds had to be widened to satisfy Gauss-Bonnet, or cannot be widened that far.
  bool strained() const { return used_reach_ > reach_; }
  bool feasible() const { return used_reach_ <= widest_reach; }

  // By how much the variance would fall with a cone at each site, (sites): exact, but for the estimate of the
  // diagonal, where no further curvature comes to its bound (orthogonal matching pursuit).
  Eigen::VectorXd gains() const { return gains(explain().by_all); }
  // The same with what the cones explain of the diagonal of H, (sites), known already.
  Eigen::VectorXd gains(const Eigen::VectorXd& explained) const;

  // What all cones explain of the diagonal of H: a curvature added anywhere is taken up in part by theirs.
  struct Explained {
    Eigen::VectorXd by_all;     // (sites)
    std::vector<int> free;      // places whose curvatures are at no bound
    Eigen::MatrixXd responses;  // (sites, free) what these do, negative
    Eigen::VectorXd inverse;    // (free) diagonal of the inverse that this comes from
    // What the others would explain without one.
    Eigen::VectorXd without(int place) const;
  };
  Explained explain() const;

  // By how much it would rise, to first order, without each of the cones, (k).
  Eigen::VectorXd losses() const;

 private:
  void fit();
  std::vector<int> free_places() const;
  Eigen::MatrixXd inverse_over(const std::vector<int>& free) const;
  Eigen::VectorXd first_gains() const;

  const PlacementProblem* problem_;
  double reach_, used_reach_ = 0;
  std::vector<int> sites_;
  Eigen::MatrixXd columns_;  // (all sites, k)
  Eigen::VectorXd curvature_, low_, high_;
  double variance_ = 0;
};

}  // namespace lsgp
