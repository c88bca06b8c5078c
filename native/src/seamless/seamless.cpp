// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/seamless.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/text.hpp"
#include "plane/layout.hpp"
#include "prescription/quantize_curvature.hpp"
#include "seamless/quantize_layout.hpp"
#include "split/split_map.hpp"

namespace lsgp {

namespace {

constexpr double most_tiles = 16384;       // beyond, float32 has too few digits left within a cell
constexpr double coarsest_tiles = 4;       // tried for an automatic grid
constexpr double acceptable_growth = 1.1;  // of the energy by an automatic grid
constexpr double acceptable_turn = 0.02;   // radians, of directions by an automatic grid
constexpr double near_finest = 1.02;       // of the growth that the finest grid has where that is more

// The next finer size of 1, 1.5, 2, 3, 4, 6, ...
double next_size(double tiles) {
  const double power = std::exp2(std::floor(std::log2(tiles * (1 + 1e-9))));
  return tiles * (1 + 1e-9) < 1.5 * power ? 1.5 * power : 2 * power;
}

struct Grid {
  double tiles, density;  // cells along the layout's longer side, and a unit of length
  Array<QuantizedLayout> layouts;
};

// Thrown where parts cannot go on, so that the others are laid out without them.
struct PartsFailed {
  Array<Failure> failures;
};

// Runs step(part) for all parts. Throws PartsFailed.
template <typename Step>
void for_each_part(const Array<SeamlessPart>& parts, Step step) {
  PartsFailed failed;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    try {
      step(i);
    } catch (const Error& error) {
      failed.failures.push_back(failure_of(*parts[i].component, error));
    }
  }
  if (!failed.failures.empty()) throw failed;
}

class GridSearch {
 public:
  GridSearch(bool parity, const PointLattice& lattice, Array<SeamlessPart>& parts, ProgressMonitor& monitor)
      : parity_(parity),
        lattice_(lattice),
        parts_(parts),
        monitor_(monitor),
        quantizers_(parts.size()),
        relaxed_(parts.size()) {
    for_each_part(parts, [&](std::size_t i) { prepare(i); });
  }

  double extent() const {
    double longest = 0;
    for (const auto& quantizer : quantizers_) longest = std::max(longest, quantizer->extent());
    return longest;
  }
  double energy(std::size_t part) const { return quantizers_[part]->energy(); }
  const Array<Index>& relaxed(std::size_t part) const { return relaxed_[part]; }

  double energy(std::size_t part, const Eigen::VectorXcd& position) const {
    return quantizers_[part]->measure_energy(position);
  }

  // The most that a part's energy has grown by.
  double growth(const Grid& grid) const {
    double most = 1;
    for (std::size_t i = 0; i < parts_.size(); ++i) most = std::max(most, grid.layouts[i].energy / energy(i));
    return most;
  }

  // None where a part has no valid layout, or one that is distorted more than allowed.
  std::optional<Grid> lay_out(double tiles, const LayoutEffort& effort) {
    Grid grid{tiles, tiles / extent(), {}};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      auto layout = quantize(i, grid.density, effort);
      if (!layout) {
        failed_ = i;
        return std::nullopt;
      }
      grid.layouts.push_back(std::move(*layout));
    }
    return grid;
  }

  // The first of the sizes from `tiles` on that can be laid out.
  std::optional<Grid> refine(double tiles, const LayoutEffort& effort) {
    for (; tiles <= most_tiles; tiles = next_size(tiles)) {
      if (auto grid = lay_out(tiles, effort)) return grid;
    }
    return std::nullopt;
  }

  // The coarsest grid that costs no more than is acceptable, or where none does, hardly more than the finest.
  std::optional<Grid> find_coarsest() {
    if (auto grid = refine(coarsest_tiles, {acceptable_growth, acceptable_turn, true})) return grid;
    // What needs more repair takes longer: by halves between sizes, as finer grids cost less.
    Array<double> sizes;
    for (double tiles = coarsest_tiles; tiles <= most_tiles; tiles = next_size(tiles)) sizes.push_back(tiles);
    std::optional<Grid> best = lay_out(sizes.back(), {});
    if (!best) return refine(coarsest_tiles, {});
    const LayoutEffort thorough{std::max(acceptable_growth, near_finest * growth(*best)), acceptable_turn, false};
    std::size_t low = 0, high = sizes.size() - 1;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (auto grid = lay_out(sizes[middle], thorough)) {
        best = std::move(grid);
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return best;
  }

  // Throws `error` for the parts that have no layout on the finest grid; where none has one, for all together.
  [[noreturn]] void give_up(const Error& error) {
    const double density = most_tiles / extent();
    if (parts_.size() > 1) {
      for_each_part(parts_, [&](std::size_t i) {
        if (!quantizers_[i]->quantize(density, {})) throw error;
      });
    }
    throw error;
  }

  void lower_stretch(double stretch, Grid& grid) const {
    for_each_part(parts_, [&](std::size_t i) {
      quantizers_[i]->lower_stretch(stretch, parts_[i].task->importance, grid.layouts[i]);
    });
  }

  // Merges the two nearest cones of the part that could not be laid out. Returns whether there are any so near on a
  // grid of so many tiles.
  bool merge_nearest(double tiles, const Options& options) {
    for (const ConePair& pair : quantizers_[failed_]->cone_pairs()) {
      if (pair.distance * tiles > near * extent()) return false;
      if (!merge(pair, options)) continue;
      prepare(failed_);
      return true;
    }
    return false;
  }

  void restore_relaxed() {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (relaxed_[i].empty()) continue;
      relaxed_[i].clear();
      prepare(i);
    }
  }

  // Relaxes one of every two cones so near in that part. Returns whether there are any.
  bool relax_near(double tiles) {
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

 private:
  static constexpr double near = 2;  // cells

  std::optional<QuantizedLayout> quantize(std::size_t part, double density, const LayoutEffort& effort) const {
    try {
      return quantizers_[part]->quantize(density, effort);
    } catch (const Error& error) {
      throw PartsFailed{{failure_of(*parts_[part].component, error)}};
    }
  }

  void prepare(std::size_t part) {
    const SeamlessPart& of = parts_[part];
    const LatticeDemands demands{lattice_, parity_, relaxed_[part], of.task->directions};
    quantizers_[part] = std::make_unique<LayoutQuantizer>(*of.system, *of.map, demands, step_);
  }

  // One of the cones takes up the curvature of both: the one whose own is nearer to that.
  bool merge(const ConePair& pair, const Options& options) {
    SeamlessPart& part = parts_[failed_];
    const HalfedgeMesh& mesh = part.component->mesh;
    const Eigen::VectorXd& curvature = part.map->curvature.at_vertex;
    const double sum = curvature[pair.first] + curvature[pair.second];
    const auto away = [&](Index v) { return std::abs(part.system->geometry().angle_defect[v] - sum); };
    const auto [kept, given_up] =
        away(pair.first) <= away(pair.second) ? std::pair{pair.first, pair.second} : std::pair{pair.second, pair.first};
    ComponentTask merged = *part.task;
    merged.cones.vertices.clear();
    merged.cones.angles.clear();
    for (const Index v : part.task->cones.vertices) {
      if (v == given_up) continue;
      merged.cones.vertices.push_back(v);
      merged.cones.angles.push_back(mesh.flat_angle(v) - (v == kept ? sum : curvature[v]));
    }
    Options manual = options;
    manual.prescription = PrescriptionRule::manual;
    try {
      std::vector<Finding> unsaid;
      auto system =
          std::make_unique<ComponentSystem>(mesh, part.system->geometry(), merged.cones, options.factorization);
      ComponentMap map = map_component(*system, merged, manual, unsaid, monitor_);
      if (map.validity.defects() > 0) return false;
      *part.map = std::move(map);
      part.system = system.get();
      part.merged_system = std::move(system);
    } catch (const Error& error) {
      if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
      return false;  // this pair cannot be merged, another may
    }
    *part.task = std::move(merged);
    part.merged.push_back(part.component->source_vertex[given_up]);
    return true;
  }

  const bool parity_;
  const PointLattice& lattice_;
  Array<SeamlessPart>& parts_;
  ProgressMonitor& monitor_;
  Array<std::unique_ptr<LayoutQuantizer>> quantizers_;
  Array<Array<Index>> relaxed_;  // by part
  std::size_t failed_ = 0;
  // Nobody knows how many steps there will be.
  int steps_ = 0;
  const StepHook step_ = [this] { monitor_.advance(1 - std::pow(0.99, ++steps_)); };
};

void report_growth(double growth, std::vector<Finding>& findings) {
  if (growth <= acceptable_growth) return;
  findings.push_back({Code::grid_distorts,
                      concat("No grid of up to ", most_tiles,
                             " cells was found that costs at most a tenth in "
                             "distortion; this one makes that of a part ",
                             growth,
                             " times as large. Move cones that "
                             "are close to each other apart, use fewer, or unwrap small parts by themselves."),
                      {}});
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
    auto grid = search.lay_out(asked, {});
    const auto give_up_cones = [&] {
      switch (seamless.coarse_grid) {
        case CoarseGrid::merge: return search.merge_nearest(asked, options);
        case CoarseGrid::relax: return search.relax_near(asked);
        default: return false;
      }
    };
    while (!grid && give_up_cones()) grid = search.lay_out(asked, {});
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
  search.give_up(
      Error(Code::grid_too_coarse,
            concat("No grid of up to ", most_tiles,
                   " cells leaves a valid layout. Move cones that are close to each other apart, or use fewer.")));
}

// The spacing of the binary fractions below which float32 holds all coordinates of the layout exactly, a bit left for
// later moves by whole cells.
double fraction_for(double largest) { return std::exp2(std::ceil(std::log2(largest + 1)) + 1 - 24); }

Complex round_to(Complex z, double fraction) {
  return {std::round(z.real() / fraction) * fraction, std::round(z.imag() / fraction) * fraction};
}

// Volatile: GCC 12 takes two conversions to float and back, side by side, for no conversion at all.
double stored_number(double x) {
  const volatile float stored = static_cast<float>(x);
  return stored;
}

// Replaces what is almost on the lattice by what is, and everything else by numbers that float32 holds.
class ExactLayout {
 public:
  ExactLayout(const SeamlessPart& part, const PointLattice& lattice, Complex shift, Eigen::VectorXcd& position)
      : mesh_(part.component->mesh), map_(*part.map), lattice_(lattice), shift_(shift), position_(position) {
    for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
      const int q = lattice.symmetry();
      turns_.push_back((turns_of((*map_.rotation)[static_cast<Eigen::Index>(p)], q) % q + q) % q);
      const Sisters sisters = origin_sisters(mesh_, map_.cut_mesh, map_.cut_graph.cuts[p].halfedges.front());
      translations_.push_back(position[sisters.right] - lattice.unit(turns_.back()) * position[sisters.left]);
    }
  }

  void snap() {
    const double largest = std::max(position_.real().cwiseAbs().maxCoeff(), position_.imag().cwiseAbs().maxCoeff());
    const double fraction = fraction_for(largest);
    for (Complex& translation : translations_) {
      translation = on_lattice(translation) ? lattice_.nearest(translation) : round_to(translation, fraction);
    }
    const Array<char> on_cut = on_cuts(mesh_, map_.cut_graph);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!on_cut[v]) {
        if (!lattice_.square()) continue;
        // On a border as on a cut, so that the two sides of an open seam stay together.
        position_[v] = mesh_.loop_of_vertex[v] == none ? as_stored(position_[v]) : round_to(position_[v], fraction);
        continue;
      }
      const auto all = sectors(mesh_, map_.cut_graph, map_.cut_mesh, v);
      Complex z = position_[all.front().copy];
      const bool is_cone = mesh_.loop_of_vertex[v] == none && map_.curvature.at_vertex[v] != 0;
      if (is_cone && on_lattice(z - shift_)) {
        z = lattice_.nearest(z - shift_) + shift_;
      } else {
        z = lattice_.square() ? round_to(z, fraction) : as_stored(z);
      }
      for (const Sector& sector : all) {
        if (sector.copy != all.front().copy) z = cross(z, sector.opened_by);
        position_[sector.copy] = z;
      }
    }
  }

  // The cut edges, as vertex pairs, whose two sides as stored are not nearest to the turn of their cut: some have
  // collapsed to a point.
  Array<Index> find_unreadable() const {
    Array<Index> out;
    for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
      for (const Index h : map_.cut_graph.cuts[p].halfedges) {
        const Sisters tail = origin_sisters(mesh_, map_.cut_mesh, h), head = target_sisters(mesh_, map_.cut_mesh, h);
        const Complex left = as_stored(position_[head.left]) - as_stored(position_[tail.left]);
        const Complex right = as_stored(position_[head.right]) - as_stored(position_[tail.right]);
        const Complex off = right * std::conj(lattice_.unit(turns_[p]) * left);
        if (std::abs(off) > 0 && std::abs(std::arg(off)) < M_PI / lattice_.symmetry()) continue;
        out.push_back(mesh_.origin(h));
        out.push_back(mesh_.target(h));
      }
    }
    return out;
  }

  // Errors as stored: see SeamlessCut.
  Array<SeamlessCut> certify(const Component& component) const {
    Array<SeamlessCut> out;
    for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
      const Cut& path = map_.cut_graph.cuts[p];
      SeamlessCut cut{component.source_vertex[path.tail], component.source_vertex[path.head], turns_[p],
                      lattice_.nearest_coordinates(translations_[p])};
      const auto add = [&](const Sisters& sisters) {
        const Complex image =
            lattice_.unit(turns_[p]) * as_stored(position_[sisters.left]) + lattice_.point(cut.translation);
        cut.error = std::max(cut.error, std::abs(as_stored(position_[sisters.right]) - image));
      };
      for (const Index h : path.halfedges) {
        add(origin_sisters(mesh_, map_.cut_mesh, h));
        add(target_sisters(mesh_, map_.cut_mesh, h));
      }
      out.push_back(cut);
    }
    return out;
  }

 private:
  // From the copy on the right of an outgoing cut halfedge to the one on its left, seen from the vertex.
  Complex cross(Complex z, Index h) const {
    const Index cut = map_.cut_graph.cut_of[h];
    const Complex turn = lattice_.unit(turns_[cut]), translation = translations_[cut];
    return map_.cut_graph.runs_forward[h] ? std::conj(turn) * (z - translation) : turn * z + translation;
  }

  bool on_lattice(Complex z) const { return std::abs(z - lattice_.nearest(z)) < rounding; }

  static constexpr double rounding = 1e-6;  // cells

  const HalfedgeMesh& mesh_;
  const ComponentMap& map_;
  const PointLattice& lattice_;
  const Complex shift_;  // of the lattice that cones are on
  Eigen::VectorXcd& position_;
  Array<int> turns_;
  Array<Complex> translations_;
};

// Takes parts out and reports them; throws where none is left.
void leave_out(const Array<Failure>& failures, Array<SeamlessPart>& parts, std::vector<Finding>& findings) {
  const auto has_failed = [&](const SeamlessPart& part) {
    return std::any_of(failures.begin(), failures.end(),
                       [&](const Failure& failure) { return failure.component == part.component; });
  };
  parts.erase(std::remove_if(parts.begin(), parts.end(), has_failed), parts.end());
  if (parts.empty()) throw failures.front().error;
  report_skipped(failures, findings);
}

// None where single precision holds the part's cuts.
std::optional<Error> refusal_of(const ExactLayout& exact) {
  Array<Index> edges = exact.find_unreadable();
  if (edges.empty()) return std::nullopt;
  const std::string what = concat(
      count(edges.size() / 2, "cut edge is", "cut edges are"),
      " so short in the layout that single precision cannot hold how the two sides are turned. Merge vertices by "
      "distance, or unwrap small parts by themselves.");
  return Error(Code::seamless_impossible, what, {ElementKind::edges, std::move(edges)});
}

void report_cones_given_up(const SeamlessReport& report, std::vector<Finding>& findings) {
  if (!report.merged_cones.empty()) {
    findings.push_back({Code::cones_merged,
                        concat(count(report.merged_cones.size(), "cone was", "cones were"),
                               " merged with the next one, closer than the grid can tell apart. Use smaller tiles to "
                               "keep them all."),
                        {ElementKind::vertices, report.merged_cones}});
  }
  if (!report.relaxed_cones.empty()) {
    findings.push_back({Code::cones_not_snapped,
                        concat(count(report.relaxed_cones.size(), "cone found", "cones found"),
                               " no place on the grid; cuts towards it show a seam of up to ", report.error,
                               " tiles. Use smaller tiles, or merge cones."),
                        {ElementKind::vertices, report.relaxed_cones}});
  }
}

// Parts that cuts close off are placed one by one.
DividedLayout divide(const HalfedgeMesh& mesh, ComponentMap& map) {
  Array<Index> part_of_triangle;
  DividedLayout out{&map.position, Array<Index>(map.cut_mesh.copy_count()), 0};
  out.part_count = label_parts(mesh, map.cut_graph.is_cut, part_of_triangle);
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    out.part[map.cut_mesh.copy_of_corner[corner]] = part_of_triangle[corner / 3];
  }
  return out;
}

// The layouts as maps in cells, split where they overlap. A part that cannot be split leaves all maps as they are.
void split_layouts(const GridSearch& search, Complex shift, const Grid& grid, Array<SeamlessPart>& parts,
                   ProgressMonitor& monitor) {
  Array<ComponentMap> maps(parts.size());
  for_each_part(parts, [&](std::size_t i) {
    const HalfedgeMesh& mesh = parts[i].component->mesh;
    maps[i] = *parts[i].map;
    maps[i].position = grid.layouts[i].position.array() + shift;
    // Cones off the lattice leave translations off it, across which nothing may move.
    const Array<char> nowhere(mesh.halfedge_count(), 0), everywhere(mesh.halfedge_count(), 1);
    split_map({mesh, parts[i].system->geometry(), nowhere}, search.relaxed(i).empty() ? mesh.seam : everywhere, monitor,
              maps[i]);
  });
  for (std::size_t i = 0; i < parts.size(); ++i) *parts[i].map = std::move(maps[i]);
}

SeamlessReport lay_out(const Options& options, double unit_scale, Array<SeamlessPart>& parts,
                       std::vector<Finding>& findings, ProgressMonitor& monitor) {
  const Seamless& seamless = *options.seamless;
  const PointLattice lattice(symmetry(seamless.lattice));
  GridSearch search(seamless.parity, lattice, parts, monitor);
  Grid grid = find_grid(options, unit_scale, search, findings);
  if (options.mode == Mode::low_stretch && options.stretch > 0) search.lower_stretch(options.stretch, grid);
  // With parity cones are at the centres of cells: around a corner of cells an odd number of them may meet.
  const Complex shift = seamless.parity ? Complex(0.5, 0.5) : Complex(0, 0);
  if (options.overlaps == Overlaps::split) {
    split_layouts(search, shift, grid, parts, monitor);
  } else {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].map->position = grid.layouts[i].position.array() + shift;
  }
  Array<DividedLayout> layouts;
  for (const SeamlessPart& part : parts) layouts.push_back(divide(part.component->mesh, *part.map));
  arrange_on_lattice(layouts, lattice, seamless.parity ? 2 : 1);

  SeamlessReport report;
  report.symmetry = lattice.symmetry();
  report.tiles = grid.tiles;
  report.tile_size = 1 / (grid.density * unit_scale);
  report.cell = seamless.cell;
  double area = 0, before = 0, after = 0;
  Array<Failure> failures;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SeamlessPart& part = parts[i];
    ExactLayout exact(part, lattice, shift, part.map->position);
    if (search.relaxed(i).empty()) exact.snap();  // otherwise no binary fractions satisfy all transitions
    if (const auto refusal = refusal_of(exact)) {
      failures.push_back(failure_of(*part.component, *refusal));
      continue;
    }
    report.merged_cones.insert(report.merged_cones.end(), part.merged.begin(), part.merged.end());
    for (const Index v : search.relaxed(i)) report.relaxed_cones.push_back(part.component->source_vertex[v]);
    for (const SeamlessCut& cut : exact.certify(*part.component)) {
      report.cuts.push_back(cut);
      report.error = std::max(report.error, cut.error);
    }
    area += part.system->geometry().total_area;
    before += part.system->geometry().total_area * search.energy(i);
    // Triangles that single precision has folded to nothing, which are named, have none.
    const double stored_energy = search.energy(i, part.map->position);
    after +=
        part.system->geometry().total_area * (std::isfinite(stored_energy) ? stored_energy : grid.layouts[i].energy);
    part.map->position *= seamless.cell;
  }
  report_cones_given_up(report, findings);
  if (!failures.empty()) leave_out(failures, parts, findings);
  report.energy_before = before / area;
  report.energy_after = after / area;
  return report;
}

[[noreturn]] void refuse(const std::string& what, const char* remedy) {
  throw Error(Code::wrong_parameter, concat(what, " ", remedy));
}

}  // namespace

Complex as_stored(Complex z) { return {stored_number(z.real()), stored_number(z.imag())}; }

void require_valid(const Seamless& seamless, const Options& options, const Pins& pins) {
  const auto positive = [](const std::optional<double>& value) {
    return !value || (std::isfinite(*value) && *value > 0);
  };
  if (seamless.tiles && seamless.tile_size) {
    refuse("Both a number and a size of tiles are given.", "Give one of them.");
  }
  if (!positive(seamless.tiles) || (seamless.tiles && *seamless.tiles > most_tiles)) {
    refuse(concat("The number of tiles is ", *seamless.tiles, "."), "Choose one above 0, up to 16384.");
  }
  if (!positive(seamless.tile_size)) {
    refuse(concat("The tiles' size is ", *seamless.tile_size, "."), "Choose one above 0.");
  }
  int exponent = 0;
  if (!positive(seamless.cell) || std::frexp(seamless.cell, &exponent) != 0.5 || seamless.cell > 1 ||
      seamless.cell < 1 / most_tiles) {
    refuse(concat("The cell's side is ", seamless.cell, "."), "Choose a power of two, 1 or less.");
  }
  if (seamless.parity && seamless.lattice != Lattice::square) {
    refuse("Only square cells can be told black from white.", "Choose the square lattice, or no parity.");
  }
  if (options.method == Method::lscm) {
    refuse("Least squares conformal maps have no transitions to round.", "Choose the method lsgp.");
  }
  if (options.border == BorderMode::straight) {
    refuse("Straight borders cannot be kept in a seamless layout.", "Leave the borders free.");
  }
  if (!pins.corners.empty()) {
    throw Error(Code::pins_conflict,
                "Pinned texture coordinates cannot be kept in a seamless layout, whose places are the lattice's. "
                "Unpin them.");
  }
}

void require_quantizable(const HalfedgeMesh& mesh, const ComponentMap& map) {
  if (map.validity.defects() == 0) return;
  Array<Index> where = map.validity.wrong_angle_sums;
  for (const Index f : map.validity.flipped) {
    for (int c = 0; c < 3; ++c) where.push_back(mesh.triangles(f, c));
  }
  throw Error(
      Code::seamless_impossible,
      concat("With angles rounded for the lattice ", count(map.validity.flipped.size(), "triangle is", "triangles are"),
             " flipped and ", count(map.validity.wrong_angle_sums.size(), "vertex turns", "vertices turn"),
             " wrongly, so there is no layout to start from. Move or add cones nearby."),
      {ElementKind::vertices, std::move(where)});
}

SeamlessReport make_seamless(const Options& options, double unit_scale, Array<SeamlessPart>& parts,
                             std::vector<Finding>& findings, ProgressMonitor& monitor) {
  for (;;) {
    std::vector<Finding> found;
    try {
      SeamlessReport report = lay_out(options, unit_scale, parts, found, monitor);
      findings.insert(findings.end(), found.begin(), found.end());
      return report;
    } catch (const PartsFailed& failed) {
      leave_out(failed.failures, parts, findings);
    }
  }
}

}  // namespace lsgp
