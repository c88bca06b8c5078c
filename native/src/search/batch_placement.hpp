// SPDX-License-Identifier: GPL-3.0-or-later
// Hundreds of cones and more: placed and exchanged in batches.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "base/progress_monitor.hpp"
#include "mesh/nearest_distance.hpp"
#include "search/cone_search.hpp"
#include "search/cone_set.hpp"

namespace lsgp {

// Choosing cones one by one needs the columns of H at all sites and a fit for each cone. Here a batch of cones is
// chosen at
// once, apart from each other, and one fit of all curvatures follows: two back-substitutions a cone, some 20 fits from
// 60 cones to 1,000, and memory for their own block of H.
class BatchPlacement {
 public:
  // search: for single cones of the same problem.
  BatchPlacement(Borrowed<const Geometry> geometry, Borrowed<const ConeSearch> search, double reach,
                 ProgressMonitor& monitor)
      : mesh_(search.get().mesh()),
        geometry_(geometry),
        problem_(search.get().problem()),
        search_(search),
        reach_(reach),
        kept_(search.get().kept()),
        monitor_(monitor) {}

  void add(const Array<int>& sites);  // two back-substitutions each, and a fit
  void grow(int cones);               // until there are so many, or no room is left

  // Removes the least important tenth of the cones and places them where they gain most, as long as that helps.
  void exchange(int rounds);

  const Array<int>& sites() const { return state_.sites; }
  const Eigen::VectorXd& curvature() const { return state_.fit.curvature; }
  bool feasible() const { return state_.fit.feasible(); }
  int cone_count() const { return problem_.cone_count(state_.sites); }

 private:
  struct State {
    Array<int> sites;
    Eigen::MatrixXd hessian;  // (k, k) their block of H
    CurvatureFit fit;
  };

  void remove(const Array<int>& places);
  Array<int> least_needed(int count) const;  // places
  double objective() const { return state_.fit.variance + problem_.mean_price(state_.sites); }
  NearestDistance distances() const;
  Eigen::VectorXd slopes() const;
  double spread_of(const Array<int>& sites, const Eigen::VectorXd& far) const;
  Array<int> choose(int cones, double spread, int rings) const;

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const PlacementProblem& problem_;
  const ConeSearch& search_;
  const double reach_;
  const int kept_;
  ProgressMonitor& monitor_;
  State state_;
};

}  // namespace lsgp
