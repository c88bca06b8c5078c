// SPDX-License-Identifier: GPL-3.0-or-later
// The size of the common grid of all components of a seamless layout.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "seamless/quantize_layout.hpp"
#include "seamless/seamless_component.hpp"

namespace lsgp {

constexpr double most_tiles = 16384;  // beyond, float32 has too few digits left within a cell

struct Grid {
  double tiles, density;  // cells along the layout's longer side, and per unit of length
  Array<QuantizedLayout> layouts;
};

// The layouts of all components on a sequence of grids.
class GridSearch {
 public:
  GridSearch(const Options& options, PointLattice lattice, Array<SeamlessComponent>& components,
             ProgressMonitor& monitor);

  double extent() const;
  double energy(std::size_t component) const { return quantizers_[component]->energy(); }
  const Array<Index>& relaxed(std::size_t component) const { return relaxed_[component]; }

  double energy(std::size_t component, const Eigen::VectorXcd& position) const;
  PerHalfedge<ReleaseReason> release_reasons(std::size_t component, const Grid& grid) const {
    return quantizers_[component]->release_reasons(grid.layouts[component]);
  }

  // The largest growth of a component's energy.
  double growth(const Grid& grid) const;

  // None if a component has no valid layout, or only one with too much distortion.
  std::optional<Grid> lay_out(double tiles, const LayoutEffort& effort);

  // With as many features as this grid keeps. None as of lay_out without limits.
  std::optional<Grid> lay_out_given(double tiles);

  // The first of the sizes from `tiles` on that can be laid out.
  std::optional<Grid> refine(double tiles, const LayoutEffort& effort);

  // The coarsest grid of acceptable cost, or if there is none, of hardly more cost than the finest.
  std::optional<Grid> find_coarsest();

  // Throws GRID_TOO_COARSE for the components without layout on the finest grid, or without one together.
  [[noreturn]] void give_up();

  void lower_stretch(double stretch, Grid& grid) const;

  // Merges the two nearest cones of the component that could not be laid out. Returns whether there are any so near on
  // a grid of so many tiles.
  bool merge_nearest(double tiles, const Options& options);

  void restore_relaxed();

  // Relaxes one of every two cones so near in that component. Returns whether there are any.
  bool relax_near(double tiles);

 private:
  static constexpr double near = 2;  // cells

  std::optional<QuantizedLayout> quantize(std::size_t component, double density, const LayoutEffort& effort) const;

  void prepare(std::size_t component);

  // Why a component has no layout on the finest grid, in its numbering.
  Error refusal_of(std::size_t component);

  // The coarsest of these sizes that can be laid out, if finer ones can where coarser ones can; finest: of the last
  // one.
  Grid bisect(const Array<double>& sizes, const LayoutEffort& effort, Grid finest);

  // The coarsest grid with these features.
  std::optional<Grid> find_coarsest_with_features();

  // Releases features until there is a grid; none if releasing a few times does not help, or there are no features.
  template <typename LayOut>
  std::optional<Grid> loosen(const LayOut& lay_out_features);

  // One of the cones takes up the curvature of both: the one whose own is nearer to that.
  bool merge(const ConePair& pair, const Options& options);

  const bool parity_, creases_, whole_features_;
  const PointLattice lattice_;
  Array<SeamlessComponent>& components_;
  ProgressMonitor& monitor_;
  Array<std::unique_ptr<LayoutQuantizer>> quantizers_;
  Array<Array<Index>> relaxed_;  // by component
  std::size_t failed_ = 0;
  // The number of steps is not known in advance.
  int steps_ = 0;
  const StepHook step_ = [this] { monitor_.advance(1 - std::pow(0.99, ++steps_)); };
};

// The requested grid, or one nearby that has a layout.  unit_scale: from the components' positions to the caller's.
// Throws WRONG_PARAMETER, GRID_TOO_COARSE.
Grid find_grid(const Options& options, double unit_scale, GridSearch& search, std::vector<Finding>& findings);

}  // namespace lsgp
