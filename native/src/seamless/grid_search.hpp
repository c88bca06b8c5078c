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

constexpr double most_tiles = 16384;     // beyond, float32 has too few digits left within a cell
constexpr double most_unsaid_scale = 2;  // of a component's layout, over the size that its tiles imply

struct Grid {
  double tiles, density;  // cells along the layout's longer side, and per unit of length
  Array<QuantizedLayout> layouts;
};

// The layouts of all components on a common grid. Components too small for it have a finer one of their own, so that
// their tiles are smaller on the surface.
class GridSearch {
 public:
  GridSearch(const Options& options, PointLattice lattice, Array<SeamlessComponent>& components,
             ProgressMonitor& monitor);

  // The longest side of a component's layout.
  double extent() const { return extent_; }
  double energy(std::size_t component) const { return quantizers_[component]->energy(); }
  const Array<Index>& relaxed(std::size_t component) const { return relaxed_[component]; }

  double energy(std::size_t component, const Eigen::VectorXcd& position) const;
  // Cells per unit of length.
  double scale(std::size_t component, const Eigen::VectorXcd& position) const;
  PerHalfedge<ReleaseReason> release_reasons(std::size_t component, const Grid& grid) const {
    return quantizers_[component]->release_reasons(grid.layouts[component]);
  }

  // The largest growth of a component's energy.
  double growth(const Grid& grid) const;

  // The coarsest grid of acceptable cost, or if there is none, of hardly more cost than the finest. Throws
  // ComponentsFailed, with GRID_TOO_COARSE, for the components without layout on the finest grid.
  Grid find_coarsest();

  // A grid of so many tiles, or if more than small components need a finer one, the first of these. What a component
  // without layout does before its grid is refined depends on options. Throws as find_coarsest.
  Grid find_given(double tiles, const Options& options);

  void lower_stretch(double stretch, Grid& grid) const;

 private:
  static constexpr double near = 2;  // cells

  // A component's layout on a grid of so many tiles of the whole layout.
  struct SizedLayout {
    double tiles = 0;
    LayoutEffort effort{};
    QuantizedLayout layout{};
  };

  void prepare(std::size_t component);
  void measure_extent();

  // None if the component has no valid layout, or only one with too much distortion.
  std::optional<SizedLayout> lay_out(std::size_t component, double tiles, const LayoutEffort& effort) const;

  // With as many features as this grid keeps. None as of lay_out without limits.
  std::optional<SizedLayout> lay_out_given(std::size_t component, double tiles) const;

  // The first of the sizes from `tiles` to the finest on which the component can be laid out.
  std::optional<SizedLayout> refine(std::size_t component, double tiles, double finest,
                                    const LayoutEffort& effort) const;

  // The first size tried for a component, from `tiles` on: with lattice points, it is as large as a cell there, or as
  // the whole layout if that is smaller.
  double coarsest_size(std::size_t component, double tiles) const;

  // Of the whole layout, where the component has the most tiles.
  double finest_size(std::size_t component) const;

  // The coarsest of these sizes from `tiles` on.
  std::optional<SizedLayout> find_coarsest(std::size_t component, double tiles) const;

  // The coarsest of these sizes on which it can be laid out, if finer ones can where coarser ones can; finest: on the
  // last one.
  SizedLayout bisect(std::size_t component, const Array<double>& sizes, const LayoutEffort& effort,
                     SizedLayout finest) const;

  // The coarsest one with these features.
  std::optional<SizedLayout> find_coarsest_with_features(std::size_t component, double coarsest) const;

  // Releases features until there is a layout; none if releasing a few times does not help, or there are no features.
  template <typename LayOut>
  std::optional<SizedLayout> loosen(std::size_t component, const LayOut& lay_out_features) const;

  // The least of the components' values that is exceeded on at most this share of their area.
  double exceeded_on(double share, const Array<double>& values) const;

  // Energy of isometric layouts of these scales, or the least one, at their best common scale.
  double energy_of_scales(const Array<double>& scales, double least) const;

  // All components with so many tiles; those that need more keep their own.
  Grid on_common_grid(double tiles, Array<SizedLayout> own) const;

  // Why a component has no layout on the finest grid, in its numbering.
  Error refusal_of(std::size_t component) const;

  // Gives up cones of a component, as options ask for. Returns whether there are any.
  bool give_up_cones(std::size_t component, double tiles, const Options& options);

  // Merges the component's two nearest cones. Returns whether there are any so near on a grid of so many tiles.
  bool merge_nearest(std::size_t component, double tiles, const Options& options);

  // One of the cones takes up the curvature of both: the one whose own is nearer to that.
  bool merge(std::size_t index, const ConePair& pair, const Options& options);

  // Relaxes one of every two cones so near. Returns whether there are any.
  bool relax_near(std::size_t component, double tiles);

  void restore_relaxed(std::size_t component);

  const bool parity_, creases_;
  const FeaturePlaces feature_places_;
  const PointLattice lattice_;
  Array<SeamlessComponent>& components_;
  Array<double> area_;  // of the components' surfaces
  double extent_ = 0;
  ProgressMonitor& monitor_;
  Array<std::unique_ptr<LayoutQuantizer>> quantizers_;
  Array<Array<Index>> relaxed_;  // by component
  // The number of steps is not known in advance.
  int steps_ = 0;
  const StepHook step_ = [this] { monitor_.advance(1 - std::pow(0.99, ++steps_)); };
};

// The requested grid, or one nearby that has a layout. unit_scale: from the components' positions to the caller's.
// Throws WRONG_PARAMETER, GRID_TOO_COARSE.
Grid find_grid(const Options& options, double unit_scale, GridSearch& search, std::vector<Finding>& findings);

}  // namespace lsgp
