// SPDX-License-Identifier: GPL-3.0-or-later
// Cones chosen by the stretch that their log scale predicts.
#pragma once

#include <limits>
#include <optional>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/placement.hpp"
#include "prescription/curvature.hpp"
#include "search/batch_placement.hpp"
#include "search/cone_search.hpp"

namespace lsgp {

// Cones at some vertices, with curvatures.
struct ConeChoice {
  Array<Index> vertices;
  Eigen::VectorXd curvature;
  double predicted_l2 = 1;  // infinite where these cones cannot take up the curvature
  Index left_flat = 0;      // cones that rounding made flat, which were given up

  bool is_possible() const { return predicted_l2 < std::numeric_limits<double>::infinity(); }
};

struct PlacementEffort {
  int probes;  // random, of the diagonal of H
  int sweeps;  // of exchange
  ExchangeEffort exchange;
};
constexpr PlacementEffort usual_effort{48, 2, {2, 0.998}};
// For a number of cones, which does not grow in stages; rounding would undo its gain.
constexpr PlacementEffort thorough_effort{96, 4, {4, 0.9995}};

// Of which cones are chosen, at most, and where their number is given or large.
constexpr int usual_sites = 4000, sites_of_many = 12000;

constexpr double isometric_l2 = 1.001;  // L2 stretch at which no cone is dropped
// Cones at which sets are exchanged. Any surface may get as many as `most_on_any`, more of them only those with enough
// vertices, and more than all stages those that have more curvature.
constexpr int cone_stages[] = {4, 6, 8, 10, 12, 15, 19, 24, 30, 37, 46, 57, 71, 89, 111};
constexpr int most_on_any = 57;
// Within which cones are chosen. Beyond the second, maps begin to miss their prediction; beyond the fourth, many do.
constexpr double reaches[] = {usual_reach, wider_reach, 1.0, 1.15, 1.6};
// That are tried in turn, since the cones that cost least come from each of them: on twelve generated heads and bodies
// more than 30 takes half as many cones again and was never the cheapest.
constexpr double price_weights[] = {30, 10, 3};
constexpr int least_vertices_a_cone = 4;  // of a surface that gets more cones than any may
constexpr int most_one_by_one = 60;       // cones that are chosen one by one, more of them in batches

class ConeChooser {
 public:
  ConeChooser(const PlacementTask& task, PlacementOptions options, int most_sites, ProgressMonitor& monitor);
  ConeChooser(const ConeChooser&) = delete;
  ConeChooser& operator=(const ConeChooser&) = delete;

  // This many cones, existing ones included, or as many as there is room for.
  ConeChoice choose(int count);
  // As many, one by one, with curvatures within this of the angle defects, in units of pi; see CurvatureBounds.
  ConeChoice choose_within(double reach, int count);
  // As many at the extrema of the log scale that is 0 at the cones so far (Ben-Chen et al. 2008), then exchanged: where
  // limbs have too few cones this sees better what is stretched most.
  ConeChoice choose_harmonically(int count);
  // These cones and `more` others where `wanted`, (n), is largest, apart from each other.
  ConeChoice choose_more(const ConeChoice& present, const Eigen::VectorXd& wanted, int more);
  // The same cones with one that was not there before moved to another vertex; none if no cone may be there.
  std::optional<ConeChoice> choose_moved(const ConeChoice& present, Index from, Index to);
  // The same cones with these curvatures, one for each.
  ConeChoice choice_with(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const;

  // Sites have prices if the costs of cuts differ; their weight is 0 at first. weight: of the most expensive cones, as
  // a share of the variance with which the target is just reached.
  bool has_prices() const { return (prices_.array() > 0).any(); }
  void weigh_prices(double weight);
  void forget_prices();

  // The parts of which sets of cones are made.
  ConeSet existing(double reach) const;
  BatchPlacement batches(double reach) { return {task_.geometry, search_, reach, monitor_}; }
  const ConeSearch& search() const { return search_; }
  const Array<Site>& sites() const { return kernel_.sites(); }
  Index place_count() const;  // single cones at all sites
  bool reaches_all() const { return sites_.reaches_all; }
  int existing_count() const;  // cones, with those that mirror them
  // Of a quarter turn each, as many as Gauss-Bonnet asks for.
  double required_count() const;

  // The set of the least predicted stretch among those after each sweep of exchange.
  ConeSet exchanged(ConeSet set) const;

  // The choice that a ConeSet or a BatchPlacement leads to, with rounded angles if a lattice is given.
  template <typename Set>
  ConeChoice settled(const Set& set);
  template <typename Set>
  double predicted_l2(const Set& set) const;

  // The angles that are given, for cones at these vertices.
  ComponentCones with_given_angles(const Array<Index>& vertices) const;
  ComponentCones with_angles(const ConeChoice& choice) const;
  Eigen::VectorXd given_curvature() const;  // (n) NaN where none is given

  const BorderConditions& border() const { return border_; }
  const LogScale& scale() const { return scale_; }
  const PlacementTask& task() const { return task_; }
  const PlacementOptions& options() const { return options_; }
  // Whether so many cones are more than are wanted.
  bool are_too_many(std::ptrdiff_t count) const { return !options_.count && options_.most && count > *options_.most; }
  const PlacementProblem& problem() const { return problem_; }
  ProgressMonitor& monitor() { return monitor_; }

 private:
  LogScaleVariance make_kernel();
  Array<int> existing_sites() const;
  template <typename Set>
  ConeChoice choice_of(const Set& set) const;
  template <typename Set>
  ConeChoice rounded(const Set& set, Lattice lattice);
  ConeChoice choose_at(const Array<int>& sites);
  ConeChoice choose_in_batches(int count);
  ConeChoice quantized(ConeChoice choice, int rotation_order);
  Array<Index> vertices_of(const Array<int>& sites) const;

  const PlacementTask task_;
  const PlacementOptions options_;
  const PlacementEffort effort_;
  ProgressMonitor& monitor_;
  BorderConditions border_;
  LogScale scale_;
  ConeSites sites_;
  LogScaleModel model_;
  LogScaleVariance kernel_;
  CurvatureBounds limits_;
  Eigen::VectorXd prices_;  // (sites) of `site_prices`
  PlacementProblem problem_;
  ConeSearch search_;
};

}  // namespace lsgp
