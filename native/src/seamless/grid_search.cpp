// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.hpp"
#include "pipeline/mapping.hpp"

namespace lsgp {

namespace {

constexpr double coarsest_tiles = 4;  // tried for an automatic grid
using Features = LayoutEffort::Features;

constexpr double finest_with_features = 128;  // tried for an automatic grid
constexpr int most_loosenings = 8;            // of features that find no place on it
constexpr double acceptable_growth = 1.1;     // of the energy by an automatic grid
constexpr double acceptable_turn = 0.02;      // radians, of directions by an automatic grid
constexpr double near_finest = 1.02;          // of the growth that the finest grid has where that is more

// The next finer size of 1, 1.5, 2, 3, 4, 6, ...
double next_size(double tiles) {
  const double power = std::exp2(std::floor(std::log2(tiles * (1 + 1e-9))));
  return tiles * (1 + 1e-9) < 1.5 * power ? 1.5 * power : 2 * power;
}

Array<double> sizes_up_to(double finest) {
  Array<double> out;
  for (double tiles = coarsest_tiles; tiles <= finest; tiles = next_size(tiles)) out.push_back(tiles);
  return out;
}

void report_growth(double growth, std::vector<Finding>& findings) {
  if (growth <= acceptable_growth) return;
  findings.push_back({Code::grid_distorts,
                      concat("No grid of up to ", most_tiles,
                             " cells was found that costs at most a tenth in "
                             "distortion; this one multiplies that of a component by ",
                             rounded(growth, 3),
                             ". Move cones that are close to "
                             "each other apart, use fewer, or unwrap small components separately."),
                      {}});
}

}  // namespace

GridSearch::GridSearch(const Options& options, PointLattice lattice, Array<SeamlessComponent>& components,
                       ProgressMonitor& monitor)
    : parity_(options.seamless->parity),
      creases_(options.straighten),
      whole_features_(options.seamless->whole_features),
      lattice_(lattice),
      components_(components),
      monitor_(monitor),
      quantizers_(components.size()),
      relaxed_(components.size()) {
  for_each_seamless(components, [&](std::size_t i) { prepare(i); });
}

double GridSearch::extent() const {
  double longest = 0;
  for (const auto& quantizer : quantizers_) longest = std::max(longest, quantizer->extent());
  return longest;
}

double GridSearch::energy(std::size_t component, const Eigen::VectorXcd& position) const {
  return quantizers_[component]->measure_energy(position);
}

double GridSearch::growth(const Grid& grid) const {
  double most = 1;
  for (std::size_t i = 0; i < components_.size(); ++i) most = std::max(most, grid.layouts[i].energy / energy(i));
  return most;
}

std::optional<Grid> GridSearch::lay_out(double tiles, const LayoutEffort& effort) {
  Grid grid{tiles, tiles / extent(), {}};
  for (std::size_t i = 0; i < components_.size(); ++i) {
    auto layout = quantize(i, grid.density, effort);
    if (!layout) {
      failed_ = i;
      return std::nullopt;
    }
    grid.layouts.push_back(std::move(*layout));
  }
  return grid;
}

std::optional<Grid> GridSearch::refine(double tiles, const LayoutEffort& effort) {
  const double finest = effort.features == Features::required ? finest_with_features : most_tiles;
  for (; tiles <= finest; tiles = next_size(tiles)) {
    if (auto grid = lay_out(tiles, effort)) return grid;
  }
  return std::nullopt;
}

template <typename LayOut>
std::optional<Grid> GridSearch::loosen(const LayOut& lay_out_features) {
  const bool has_features = std::any_of(quantizers_.begin(), quantizers_.end(),
                                        [](const auto& quantizer) { return quantizer->has_features(); });
  for (int loosenings = 0; has_features && loosenings <= most_loosenings; ++loosenings) {
    if (auto grid = lay_out_features()) return grid;
    if (!quantizers_[failed_]->loosen_features()) break;
  }
  return std::nullopt;
}

std::optional<Grid> GridSearch::lay_out_given(double tiles) {
  LayoutEffort with_features;
  with_features.features = Features::required;
  if (auto grid = loosen([&] { return lay_out(tiles, with_features); })) return grid;
  return lay_out(tiles, {});
}

Grid GridSearch::bisect(const Array<double>& sizes, const LayoutEffort& effort, Grid finest) {
  std::size_t low = 0, high = sizes.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (auto grid = lay_out(sizes[middle], effort)) {
      finest = std::move(*grid);
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return finest;
}

// Where layouts take long, those that fail on the finest grid are not tried on others.
std::optional<Grid> GridSearch::find_coarsest_with_features() {
  const LayoutEffort effort{acceptable_growth, acceptable_turn, true, Features::required};
  const bool takes_long = std::any_of(quantizers_.begin(), quantizers_.end(),
                                      [](const auto& quantizer) { return quantizer->has_many_features(); });
  if (takes_long && !lay_out(finest_with_features, effort)) return std::nullopt;
  return refine(coarsest_tiles, effort);
}

std::optional<Grid> GridSearch::find_coarsest() {
  if (auto grid = loosen([&] { return find_coarsest_with_features(); })) return grid;
  if (auto grid = refine(coarsest_tiles, {acceptable_growth, acceptable_turn, true, Features::ignored})) return grid;
  // Layouts that need more repair take longer: bisects the sizes, since finer grids cost less.
  const Array<double> sizes = sizes_up_to(most_tiles);
  LayoutEffort without_features;
  without_features.features = Features::ignored;
  auto finest = lay_out(sizes.back(), without_features);
  if (!finest) {
    if (auto grid = refine(coarsest_tiles, without_features)) return grid;
    return lay_out(most_tiles, {});  // features can help, where they fix what is rounded
  }
  const LayoutEffort thorough{std::max(acceptable_growth, near_finest * growth(*finest)), acceptable_turn, false,
                              Features::ignored};
  return bisect(sizes, thorough, std::move(*finest));
}

void GridSearch::give_up() {
  const double density = most_tiles / extent();
  for_each_seamless(components_, [&](std::size_t i) {
    if (components_.size() == 1 || !quantizers_[i]->quantize(density, {})) throw refusal_of(i);
  });
  throw Error(Code::grid_too_coarse,
              concat("No grid of up to ", most_tiles, " cells leaves a valid layout of all components. ",
                     "Unwrap some of them separately."));
}

Error GridSearch::refusal_of(std::size_t component) {
  LayoutQuantizer& quantizer = *quantizers_[component];
  const std::string what = concat("No grid of up to ", most_tiles, " cells leaves a valid layout");
  if (quantizer.extent() < extent() && quantizer.quantize(most_tiles / quantizer.extent(), {})) {
    return Error(Code::grid_too_coarse,
                 concat(what, ": a component is too small beside others. Unwrap it separately."));
  }
  Array<Index> close;
  for (const ConePair& pair : quantizer.cone_pairs()) {
    if (pair.distance * most_tiles > near * extent()) break;
    close.push_back(pair.first);
    close.push_back(pair.second);
  }
  if (close.empty()) {
    return Error(Code::grid_too_coarse,
                 concat(what, ". Use other cones, or cut the surface into simpler components along seams."));
  }
  sort_unique(close);
  return Error(Code::grid_too_coarse,
               concat(what, ". Move cones that are close to each other in the layout apart, or use fewer."),
               {ElementKind::vertices, std::move(close)});
}

void GridSearch::lower_stretch(double stretch, Grid& grid) const {
  for_each_seamless(components_, [&](std::size_t i) {
    quantizers_[i]->lower_stretch(stretch, components_[i].task->importance, grid.layouts[i]);
  });
}

bool GridSearch::merge_nearest(double tiles, const Options& options) {
  for (const ConePair& pair : quantizers_[failed_]->cone_pairs()) {
    if (pair.distance * tiles > near * extent()) return false;
    if (!merge(pair, options)) continue;
    prepare(failed_);
    return true;
  }
  return false;
}

void GridSearch::restore_relaxed() {
  for (std::size_t i = 0; i < components_.size(); ++i) {
    if (relaxed_[i].empty()) continue;
    relaxed_[i].clear();
    prepare(i);
  }
}

bool GridSearch::relax_near(double tiles) {
  Array<Index> relaxed;
  for (const ConePair& pair : quantizers_[failed_]->cone_pairs()) {
    if (pair.distance * tiles > near * extent()) break;
    const auto listed = [&](Index v) { return std::find(relaxed.begin(), relaxed.end(), v) != relaxed.end(); };
    if (!listed(pair.first) && !listed(pair.second)) relaxed.push_back(pair.second);
  }
  if (relaxed.empty() || !relaxed_[failed_].empty()) return false;
  relaxed_[failed_] = std::move(relaxed);
  prepare(failed_);
  return true;
}

std::optional<QuantizedLayout> GridSearch::quantize(std::size_t component, double density,
                                                    const LayoutEffort& effort) const {
  try {
    return quantizers_[component]->quantize(density, effort);
  } catch (const Error& error) {
    throw ComponentsFailed{{failure_of(*components_[component].source, error)}};
  }
}

void GridSearch::prepare(std::size_t component) {
  const SeamlessComponent& of = components_[component];
  const LatticeDemands demands{lattice_, parity_,         relaxed_[component], of.task->directions,
                               creases_, whole_features_, *of.alignment};
  quantizers_[component] = std::make_unique<LayoutQuantizer>(*of.system, *of.map, demands, step_);
}

bool GridSearch::merge(const ConePair& pair, const Options& options) {
  SeamlessComponent& component = components_[failed_];
  const HalfedgeMesh& mesh = component.source->mesh;
  const Eigen::VectorXd& curvature = component.map->curvature.at_vertex;
  const double sum = curvature[pair.first] + curvature[pair.second];
  const auto away = [&](Index v) { return std::abs(component.system->geometry().angle_defect[v] - sum); };
  const auto [kept, given_up] =
      away(pair.first) <= away(pair.second) ? std::pair{pair.first, pair.second} : std::pair{pair.second, pair.first};
  ComponentTask merged = *component.task;
  merged.cones.vertices.clear();
  merged.cones.angles.clear();
  for (const Index v : component.task->cones.vertices) {
    if (v == given_up) continue;
    merged.cones.vertices.push_back(v);
    merged.cones.angles.push_back(mesh.flat_angle(v) - (v == kept ? sum : curvature[v]));
  }
  Options manual = options;
  manual.prescription = PrescriptionRule::manual;
  try {
    std::vector<Finding> unsaid;
    auto system = std::make_unique<ComponentSystem>(MetricMesh{mesh, component.system->geometry()}, merged.cones,
                                                    options.factorization);
    ComponentMap map = map_component(*system, merged, manual, unsaid, monitor_);
    if (map.validity.defects() > 0) return false;
    *component.map = std::move(map);
    component.system = system.get();
    component.merged_system = std::move(system);
    component.merged_alignment = std::make_unique<std::optional<FeatureAlignment>>();
    component.alignment = component.merged_alignment.get();
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return false;  // this pair cannot be merged, another may
  }
  *component.task = std::move(merged);
  component.merged.push_back(component.source->source_vertex[given_up]);
  return true;
}

Grid find_grid(const Options& options, double unit_scale, GridSearch& search, std::vector<Finding>& findings) {
  const Seamless& seamless = *options.seamless;
  if (!seamless.tiles && !seamless.tile_size) {
    if (auto grid = search.find_coarsest()) {
      report_growth(search.growth(*grid), findings);
      return std::move(*grid);
    }
  } else {
    const double asked = seamless.tiles ? *seamless.tiles : search.extent() / (*seamless.tile_size * unit_scale);
    if (!(asked >= 1e-6 && asked <= most_tiles)) {
      throw Error(Code::wrong_parameter,
                  concat("The grid would have ", asked, " cells along the layout; up to ", most_tiles,
                         " can be stored exactly. Choose another number or size of tiles."));
    }
    auto grid = search.lay_out_given(asked);
    const auto give_up_cones = [&] {
      switch (seamless.coarse_grid) {
        case CoarseGrid::merge: return search.merge_nearest(asked, options);
        case CoarseGrid::relax: return search.relax_near(asked);
        default: return false;
      }
    };
    while (!grid && give_up_cones()) grid = search.lay_out_given(asked);
    if (grid) return std::move(*grid);
    search.restore_relaxed();
    if (auto finer = search.refine(next_size(std::max(1.0, asked)), {})) {
      findings.push_back({Code::grid_refined,
                          concat("No layout is valid on a grid of ", asked, " cells along its longer side; it has ",
                                 finer->tiles, " now. Use fewer cones for larger tiles."),
                          {}});
      return std::move(*finer);
    }
  }
  search.give_up();
}

}  // namespace lsgp
