// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/text.hpp"
#include "pipeline/mapping.hpp"

namespace lsgp {

namespace {

constexpr double coarsest_tiles = 4;  // tried for an automatic grid
using Features = LayoutEffort::Features;

constexpr double finest_with_features = 128;  // tried for an automatic grid, along the component's layout
constexpr double cost_of_features = 4;        // how much finer they may make the common grid, where it is fine
constexpr int most_loosenings = 8;            // of features that find no place on it
constexpr double acceptable_growth = 1.1;     // of the energy by an automatic grid
constexpr double acceptable_turn = 0.02;      // radians, of directions by an automatic grid
constexpr double near_finest = 1.02;          // of the growth that the finest grid has where that is more
constexpr double small_share = 0.05;          // of the area, of components whose tiles may be smaller than elsewhere
constexpr double most_uneven = 1.25;          // scale of a component, over that of others
constexpr double most_refinement = 2;         // of a grid, for a common layout

// The next finer size of 1, 1.5, 2, 3, 4, 6, ...
double next_size(double tiles) {
  const double power = std::exp2(std::floor(std::log2(tiles * (1 + 1e-9))));
  return tiles * (1 + 1e-9) < 1.5 * power ? 1.5 * power : 2 * power;
}

// The first of these sizes from `tiles` on of at least so many.
double size_of_at_least(double least, double tiles) {
  while (tiles < least) tiles = next_size(tiles);
  return tiles;
}

Array<double> sizes_between(double tiles, double finest) {
  Array<double> out;
  for (; tiles <= finest; tiles = next_size(tiles)) out.push_back(tiles);
  return out;
}

// Indices of values, in descending order of them.
Array<std::size_t> from_largest(const Array<double>& values) {
  Array<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
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
      feature_places_(options.seamless->feature_places),
      lattice_(lattice),
      components_(components),
      monitor_(monitor),
      quantizers_(components.size()),
      relaxed_(components.size()) {
  for (const SeamlessComponent& component : components) area_.push_back(component.system->geometry().total_area);
  for_each_seamless(components, [&](std::size_t i) { prepare(i); });
  measure_extent();
}

void GridSearch::measure_extent() {
  extent_ = 0;
  for (const auto& quantizer : quantizers_) extent_ = std::max(extent_, quantizer->extent());
}

double GridSearch::energy(std::size_t component, const Eigen::VectorXcd& position) const {
  return quantizers_[component]->measure_energy(position);
}

double GridSearch::scale(std::size_t component, const Eigen::VectorXcd& position) const {
  return quantizers_[component]->measure_scale(position);
}

double GridSearch::growth(const Grid& grid) const {
  double most = 1;
  for (std::size_t i = 0; i < components_.size(); ++i) most = std::max(most, grid.layouts[i].energy / energy(i));
  return most;
}

Grid GridSearch::find_coarsest() {
  Array<SizedLayout> own(components_.size());
  Array<double> sizes(components_.size(), coarsest_tiles), scales(components_.size()), enlargements(components_.size());
  // The large ones first: others need no tiles larger than these have.
  double largest = coarsest_tiles;
  for_each_seamless(components_, from_largest(area_), [&](std::size_t i) {
    auto found = find_coarsest(i, largest);
    if (!found) throw refusal_of(i);
    sizes[i] = found->tiles;
    if (found->tiles > largest) largest = std::min(exceeded_on(small_share, sizes), most_tiles);
    scales[i] = scale(i, found->layout.position);
    enlargements[i] = scales[i] * extent() / found->tiles;
    own[i] = std::move(*found);
  });
  // On lattice points a layout may be larger than its tiles imply, so that it has the scale of others on finer grids.
  const double usual = exceeded_on(0.5, enlargements);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (enlargements[i] > most_uneven * usual) {
      sizes[i] = size_of_at_least(sizes[i] * enlargements[i] / (most_uneven * usual), sizes[i]);
    }
  }
  double tiles = std::min(exceeded_on(small_share, sizes), most_tiles);
  while (tiles < most_tiles && energy_of_scales(scales, usual * tiles / extent()) > acceptable_growth) {
    tiles = next_size(tiles);
  }
  return on_common_grid(tiles, std::move(own));
}

Grid GridSearch::find_given(double tiles, const Options& options) {
  Array<SizedLayout> own;
  Array<double> sizes;
  for_each_seamless(components_, [&](std::size_t i) {
    const double size = coarsest_size(i, tiles);
    auto found = lay_out_given(i, size);
    while (!found && give_up_cones(i, size, options)) found = lay_out_given(i, size);
    if (!found) {
      restore_relaxed(i);
      found = refine(i, next_size(std::max(1.0, size)), finest_size(i), {});
    }
    if (!found) throw refusal_of(i);
    sizes.push_back(found->tiles);
    own.push_back(std::move(*found));
  });
  const double common = std::min(exceeded_on(small_share, sizes), most_tiles);
  for (std::size_t i = 0; i < components_.size(); ++i) {
    if (own[i].tiles < common) restore_relaxed(i);
  }
  return on_common_grid(common, std::move(own));
}

std::optional<GridSearch::SizedLayout> GridSearch::lay_out(std::size_t component, double tiles,
                                                           const LayoutEffort& effort) const {
  auto layout = quantizers_[component]->quantize(tiles / extent(), effort);
  if (!layout) return std::nullopt;
  return SizedLayout{tiles, effort, std::move(*layout)};
}

std::optional<GridSearch::SizedLayout> GridSearch::lay_out_given(std::size_t component, double tiles) const {
  LayoutEffort with_features;
  with_features.features = Features::required;
  auto found = loosen(component, [&] { return lay_out(component, tiles, with_features); });
  if (!found) return lay_out(component, tiles, {});
  found->effort = {};
  return found;
}

std::optional<GridSearch::SizedLayout> GridSearch::refine(std::size_t component, double tiles, double finest,
                                                          const LayoutEffort& effort) const {
  for (; tiles <= finest; tiles = next_size(tiles)) {
    if (auto found = lay_out(component, tiles, effort)) return found;
  }
  return std::nullopt;
}

double GridSearch::coarsest_size(std::size_t component, double tiles) const {
  const LayoutQuantizer& quantizer = *quantizers_[component];
  const double least = std::min(1.0, tiles) * (extent() / quantizer.extent());
  return quantizer.has_lattice_points() ? size_of_at_least(least, tiles) : tiles;
}

double GridSearch::finest_size(std::size_t component) const {
  return most_tiles * (extent() / quantizers_[component]->extent());
}

template <typename LayOut>
std::optional<GridSearch::SizedLayout> GridSearch::loosen(std::size_t component, const LayOut& lay_out_features) const {
  LayoutQuantizer& quantizer = *quantizers_[component];
  for (int loosenings = 0; quantizer.has_features() && loosenings <= most_loosenings; ++loosenings) {
    if (auto found = lay_out_features()) return found;
    if (!quantizer.loosen_features()) break;
  }
  return std::nullopt;
}

GridSearch::SizedLayout GridSearch::bisect(std::size_t component, const Array<double>& sizes,
                                           const LayoutEffort& effort, SizedLayout finest) const {
  std::size_t low = 0, high = sizes.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (auto found = lay_out(component, sizes[middle], effort)) {
      finest = std::move(*found);
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return finest;
}

// Where layouts take long, those that fail on the finest grid are not tried on others.
std::optional<GridSearch::SizedLayout> GridSearch::find_coarsest_with_features(std::size_t component,
                                                                               double coarsest) const {
  const LayoutEffort effort{acceptable_growth, acceptable_turn, true, Features::required};
  const double finest = std::max(finest_with_features * (extent() / quantizers_[component]->extent()), coarsest);
  if (quantizers_[component]->has_many_features() && !lay_out(component, finest, effort)) return std::nullopt;
  return refine(component, coarsest, finest, effort);
}

std::optional<GridSearch::SizedLayout> GridSearch::find_coarsest(std::size_t component, double tiles) const {
  const double coarsest = coarsest_size(component, tiles), finest = finest_size(component);
  LayoutEffort effort{acceptable_growth, acceptable_turn, true, Features::ignored};
  if (auto found = loosen(component, [&] { return find_coarsest_with_features(component, coarsest); })) {
    if (found->tiles > finest_with_features) {
      if (auto coarser = refine(component, coarsest, found->tiles / cost_of_features, effort)) return coarser;
    }
    return found;
  }
  if (auto found = refine(component, coarsest, finest, effort)) return found;
  // Layouts that need more repair take longer: bisects the sizes, since finer grids cost less.
  LayoutEffort without_features;
  without_features.features = Features::ignored;
  const Array<double> sizes = sizes_between(coarsest, finest);
  auto on_finest = lay_out(component, sizes.back(), without_features);
  if (!on_finest) {
    if (auto found = refine(component, coarsest, finest, without_features)) return found;
    return lay_out(component, sizes.back(), {});  // features can help, where they fix what is rounded
  }
  const double growth = on_finest->layout.energy / energy(component);
  effort = {std::max(acceptable_growth, near_finest * growth), acceptable_turn, false, Features::ignored};
  return bisect(component, sizes, effort, std::move(*on_finest));
}

double GridSearch::exceeded_on(double share, const Array<double>& values) const {
  const Array<std::size_t> order = from_largest(values);
  const double all = std::accumulate(area_.begin(), area_.end(), 0.0);
  double above = 0;
  for (const std::size_t i : order) {
    above += area_[i];
    if (above > share * all) return values[i];
  }
  return values[order.back()];
}

double GridSearch::energy_of_scales(const Array<double>& scales, double least) const {
  double all = 0, grown = 0, shrunk = 0;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const double square = std::pow(std::max(scales[i], least), 2);
    all += area_[i];
    grown += area_[i] * square;
    shrunk += area_[i] / square;
  }
  return std::sqrt(grown * shrunk) / all;
}

Grid GridSearch::on_common_grid(double tiles, Array<SizedLayout> own) const {
  const auto lay_out_all = [&](double size) {
    Grid grid{size, size / extent(), {}};
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (own[i].tiles >= size) {
        grid.layouts.push_back(own[i].layout);
      } else if (auto finer = lay_out(i, size, own[i].effort)) {
        grid.layouts.push_back(std::move(finer->layout));
      } else {
        return std::optional<Grid>{};
      }
    }
    return std::optional<Grid>{std::move(grid)};
  };
  for (double size = tiles; size <= std::min(most_refinement * tiles, most_tiles); size = next_size(size)) {
    if (auto grid = lay_out_all(size)) return std::move(*grid);
  }
  Grid grid{tiles, tiles / extent(), {}};
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i].tiles < tiles) {
      if (auto finer = refine(i, tiles, finest_size(i), {})) own[i] = std::move(*finer);
    }
    grid.layouts.push_back(std::move(own[i].layout));
  }
  return grid;
}

Error GridSearch::refusal_of(std::size_t component) const {
  LayoutQuantizer& quantizer = *quantizers_[component];
  const std::string what = concat("No grid of up to ", most_tiles, " cells leaves a valid layout");
  Array<Index> close;
  for (const ConePair& pair : quantizer.cone_pairs()) {
    if (pair.distance * most_tiles > near * quantizer.extent()) break;
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

bool GridSearch::give_up_cones(std::size_t component, double tiles, const Options& options) {
  switch (options.seamless->coarse_grid) {
    case CoarseGrid::merge: return merge_nearest(component, tiles, options);
    case CoarseGrid::relax: return relax_near(component, tiles);
    default: return false;
  }
}

bool GridSearch::merge_nearest(std::size_t component, double tiles, const Options& options) {
  for (const ConePair& pair : quantizers_[component]->cone_pairs()) {
    if (pair.distance * tiles > near * extent()) return false;
    if (!merge(component, pair, options)) continue;
    prepare(component);
    measure_extent();
    return true;
  }
  return false;
}

void GridSearch::restore_relaxed(std::size_t component) {
  if (relaxed_[component].empty()) return;
  relaxed_[component].clear();
  prepare(component);
}

bool GridSearch::relax_near(std::size_t component, double tiles) {
  if (!relaxed_[component].empty()) return false;
  Array<Index> relaxed;
  for (const ConePair& pair : quantizers_[component]->cone_pairs()) {
    if (pair.distance * tiles > near * extent()) break;
    const auto listed = [&](Index v) { return std::find(relaxed.begin(), relaxed.end(), v) != relaxed.end(); };
    if (!listed(pair.first) && !listed(pair.second)) relaxed.push_back(pair.second);
  }
  if (relaxed.empty()) return false;
  relaxed_[component] = std::move(relaxed);
  prepare(component);
  return true;
}

void GridSearch::prepare(std::size_t component) {
  const SeamlessComponent& of = components_[component];
  const LatticeDemands demands{lattice_, parity_,         relaxed_[component], of.task->directions,
                               creases_, feature_places_, *of.alignment};
  quantizers_[component] = std::make_unique<LayoutQuantizer>(*of.system, *of.map, demands, step_);
}

bool GridSearch::merge(std::size_t index, const ConePair& pair, const Options& options) {
  SeamlessComponent& component = components_[index];
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
    Grid grid = search.find_coarsest();
    report_growth(search.growth(grid), findings);
    return grid;
  }
  const double asked = seamless.tiles ? *seamless.tiles : search.extent() / (*seamless.tile_size * unit_scale);
  if (!(asked >= 1e-6 && asked <= most_tiles)) {
    throw Error(Code::wrong_parameter,
                concat("The grid would have ", asked, " cells along the layout; up to ", most_tiles,
                       " can be stored exactly. Choose another number or size of tiles."));
  }
  Grid grid = search.find_given(asked, options);
  if (grid.tiles > asked) {
    findings.push_back({Code::grid_refined,
                        concat("No layout is valid on a grid of ", asked, " cells along its longer side; it has ",
                               grid.tiles, " now. Use fewer cones for larger tiles."),
                        {}});
  }
  return grid;
}

}  // namespace lsgp
