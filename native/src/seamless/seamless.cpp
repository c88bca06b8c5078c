// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/seamless.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "creases/features.hpp"
#include "division/cut_apart.hpp"
#include "plane/layout.hpp"
#include "seamless/exact_layout.hpp"
#include "seamless/grid_search.hpp"
#include "split/split_map.hpp"

namespace lsgp {

namespace {

// Removes components and reports them; throws if none is left.
void leave_out(const Array<Failure>& failures, Array<SeamlessComponent>& components, std::vector<Finding>& findings) {
  const auto has_failed = [&](const SeamlessComponent& component) {
    return std::any_of(failures.begin(), failures.end(),
                       [&](const Failure& failure) { return failure.component == component.source; });
  };
  components.erase(std::remove_if(components.begin(), components.end(), has_failed), components.end());
  if (components.empty()) throw failures.front().error;
  report_skipped(failures, findings);
}

// None if single precision can represent the component's cuts.
std::optional<Error> refusal_of(const ExactLayout& exact) {
  Array<Index> edges = exact.find_unreadable();
  if (edges.empty()) return std::nullopt;
  const std::string what =
      concat(count(edges.size() / 2, "cut edge is", "cut edges are"),
             " so short in the layout that single precision cannot represent the rotation between the two sides. Merge "
             "vertices by distance, or unwrap small components separately.");
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
                               " no place on the grid; cuts toward it show a seam of up to ", rounded(report.error, 2),
                               " tiles. Use smaller tiles, or merge cones."),
                        {ElementKind::vertices, report.relaxed_cones}});
  }
}

// Regions enclosed by cuts are placed individually.
DividedLayout divide(const HalfedgeMesh& mesh, ComponentMap& map) {
  PerTriangle<Index> part_of_triangle;
  DividedLayout out{&map.position, PerCopy<Index>(map.cut_mesh.copy_count()), 0};
  out.part_count = label_parts(mesh, map.cut_graph.is_cut, part_of_triangle);
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    out.part[map.cut_mesh.copy_of_corner[corner]] = part_of_triangle[corner / 3];
  }
  return out;
}

// Whether no cut, cone or crease relates the layout to the lattice.
bool may_lie_anywhere(const SeamlessComponent& component) {
  const PerHalfedge<char>& is_cut = component.map->cut_graph.is_cut;
  return std::none_of(is_cut.begin(), is_cut.end(), [](char is) { return is != 0; }) &&
         !component.alignment->has_value();
}

// The layout on the grid as a map in cells. Marked seams that no cone needed are cuts of it, too, whose transition is
// the identity until the pieces they enclose are placed.
ComponentMap map_on_grid(const SeamlessComponent& component, Complex shift, const Eigen::VectorXcd& position) {
  const HalfedgeMesh& mesh = component.source->mesh;
  ComponentMap map = *component.map;
  map.position = position.array() + shift;
  PerHalfedge<char> is_cut = map.cut_graph.is_cut;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] != none) is_cut[h] = is_cut[h] || mesh.seam[h];
  }
  if (is_cut != map.cut_graph.is_cut) {
    cut_apart(mesh, std::move(is_cut), PerTriangle<Index>(mesh.triangle_count(), 0), PerPart<Motion>(1), map);
  }
  return map;
}

// The layouts as maps in cells, split where they overlap. If a component cannot be split, all maps are left unchanged.
void split_layouts(const GridSearch& search, Complex shift, const Grid& grid, Array<SeamlessComponent>& components,
                   ProgressMonitor& monitor) {
  Array<ComponentMap> maps(components.size());
  for_each_seamless(components, [&](std::size_t i) {
    const HalfedgeMesh& mesh = components[i].source->mesh;
    maps[i] = map_on_grid(components[i], shift, grid.layouts[i].position);
    // Cones off the lattice have translations off it, across which no part may move.
    const PerHalfedge<char> nowhere(mesh.halfedge_count(), 0), everywhere(mesh.halfedge_count(), 1);
    const SplitTask task{search.relaxed(i).empty() ? mesh.seam : everywhere, components[i].system->mirroring()};
    split_map({components[i].system->surface(), nowhere}, task, monitor, maps[i]);
  });
  for (std::size_t i = 0; i < components.size(); ++i) *components[i].map = std::move(maps[i]);
}

// The creases of hard surfaces, and which of them run exactly along the axes.
class LatticeCreases {
 public:
  void add(const Component& component, const CutSurface& surface, const Eigen::VectorXcd& position) {
    const HalfedgeMesh& mesh = component.mesh;
    const PerHalfedge<char> feature = find_features(surface);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (!feature[h] || mesh.twin[h] < h) continue;
      const Complex edge = as_stored(position[surface.cut_mesh.copy_of_corner[next(h)]]) -
                           as_stored(position[surface.cut_mesh.copy_of_corner[h]]);
      const double length = surface.geometry.length[h];
      const std::array<Index, 2> ends{component.source_vertex[mesh.origin(h)], component.source_vertex[mesh.target(h)]};
      const bool is_aligned = is_along_axis(edge);
      edges_.insert(edges_.end(), ends.begin(), ends.end());
      is_aligned_.push_back(is_aligned);
      all_ += length;
      if (is_aligned) continue;
      off_ += length;
      if (mesh.has_features() && mesh.feature[h]) continue;  // which are reported with all others that are marked
      most_ = std::max(most_, std::abs(std::remainder(std::arg(edge), M_PI / 2)));
      off_lattice_.insert(off_lattice_.end(), ends.begin(), ends.end());
    }
  }

  void report(SeamlessReport& report, std::vector<Finding>& findings) && {
    if (all_ > 0) report.feature_share = 1 - off_ / all_;
    report.creases = std::move(edges_);
    report.is_crease_aligned = std::move(is_aligned_);
    if (off_lattice_.empty()) return;
    findings.push_back(
        {Code::features_off_lattice,
         concat(count(off_lattice_.size() / 2, "edge", "edges"), " of creases, ", rounded(100 * off_ / all_, 2),
                " % of their length, ", off_lattice_.size() == 2 ? "does" : "do", " not run along the lattice, up to ",
                rounded(most_ * 180 / M_PI, 2),
                " degrees off: they would cross or fold, or cost too much stretch. Use smaller tiles, or "
                "mark cones at the ends of these creases."),
         {ElementKind::edges, std::move(off_lattice_)}});
  }

 private:
  double all_ = 0, off_ = 0, most_ = 0;  // lengths, and radians
  Array<Index> edges_, off_lattice_;     // all, and those off the axes that are not marked, as the caller's vertices
  Array<char> is_aligned_;
};

// Components that are larger in the layout than the size of the tiles implies, as small ones are.
class OversizeReport {
 public:
  explicit OversizeReport(double density) : density_(density) {}

  // scale: of its layout, cells per unit of length.
  void add(const SeamlessComponent& component, double scale) {
    if (!(scale > most_unsaid_scale * density_)) return;
    ++components_;
    worst_ = std::max(worst_, scale / density_);
    const PerTriangle<Index>& triangles = component.source->source_triangle;
    triangles_.insert(triangles_.end(), triangles.begin(), triangles.end());
  }

  void report(std::vector<Finding>& findings) {
    if (components_ == 0) return;
    std::sort(triangles_.begin(), triangles_.end());
    findings.push_back(
        {Code::high_distortion,
         concat("Tiles are up to ", rounded(worst_, 3), " times smaller than elsewhere on ",
                count(components_, "component", "components"),
                ", too small for tiles as large as elsewhere. Use smaller tiles, or unwrap small components "
                "separately."),
         {ElementKind::triangles, std::move(triangles_)}});
  }

 private:
  const double density_;  // cells per unit of length
  int components_ = 0;
  double worst_ = 1;
  Array<Index> triangles_;
};

SeamlessReport lay_out(const Options& options, double unit_scale, Array<SeamlessComponent>& components,
                       std::vector<Finding>& findings, ProgressMonitor& monitor) {
  const Seamless& seamless = *options.seamless;
  const PointLattice lattice(rotation_order(seamless.lattice));
  GridSearch search(options, lattice, components, monitor);
  Grid grid = find_grid(options, unit_scale, search, findings);
  if (options.mode == Mode::low_stretch && options.stretch > 0) search.lower_stretch(options.stretch, grid);
  // With parity cones are at the centers of cells: around a corner of cells an odd number of them may meet.
  const Complex shift = seamless.parity ? Complex(0.5, 0.5) : Complex(0, 0);
  if (options.overlaps == Overlaps::split) {
    split_layouts(search, shift, grid, components, monitor);
  } else {
    for (std::size_t i = 0; i < components.size(); ++i)
      *components[i].map = map_on_grid(components[i], shift, grid.layouts[i].position);
  }
  Array<DividedLayout> layouts;
  for (const SeamlessComponent& component : components) {
    layouts.push_back(divide(component.source->mesh, *component.map));
    layouts.back().may_lie_anywhere = may_lie_anywhere(component);
  }
  arrange_on_lattice(layouts, lattice, seamless.parity ? 2 : 1);

  SeamlessReport report;
  report.rotation_order = lattice.rotation_order();
  report.tiles = grid.tiles;
  report.tile_size = 1 / (grid.density * unit_scale);
  report.cell = seamless.cell;
  double area = 0, before = 0, after = 0;
  LatticeCreases creases;
  OversizeReport oversize(grid.density);
  Array<Failure> failures;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const SeamlessComponent& component = components[i];
    ExactLayout exact(component, lattice, shift, component.map->position);
    const ComponentMap& map = *component.map;
    const auto surface = [&] { return component.system->open(map.cut_graph, map.cut_mesh); };
    if (search.relaxed(i).empty()) {  // otherwise no binary fractions satisfy all transitions
      exact.snap();
      Array<Index> flipped = find_flipped(map.cut_mesh, map.position);
      if (!flipped.empty()) {
        exact.turn_upright(std::move(flipped), features_to_align(surface(), options.straighten));
      }
    }
    if (const auto refusal = refusal_of(exact)) {
      failures.push_back(failure_of(*component.source, *refusal));
      continue;
    }
    report.merged_cones.insert(report.merged_cones.end(), component.merged.begin(), component.merged.end());
    for (const Index v : search.relaxed(i)) report.relaxed_cones.push_back(component.source->source_vertex[v]);
    for (const SeamlessCut& cut : exact.certify(*component.source)) {
      report.cuts.push_back(cut);
      report.error = std::max(report.error, cut.error);
    }
    if (options.straighten && lattice.rotation_order() == 4) {
      creases.add(*component.source, surface(), map.position);
    }
    area += component.system->geometry().total_area;
    before += component.system->geometry().total_area * search.energy(i);
    // Triangles that collapsed in single precision, which are reported, have none.
    const double stored_energy = search.energy(i, component.map->position);
    after += component.system->geometry().total_area *
             (std::isfinite(stored_energy) ? stored_energy : grid.layouts[i].energy);
    oversize.add(component, search.scale(i, component.map->position));
    component.map->position *= seamless.cell;
    component.map->release_reasons = search.release_reasons(i, grid);
  }
  report_cones_given_up(report, findings);
  if (!failures.empty()) leave_out(failures, components, findings);
  std::move(creases).report(report, findings);
  oversize.report(findings);
  report.energy_before = before / area;
  report.energy_after = after / area;
  return report;
}

[[noreturn]] void refuse(const std::string& what, const char* remedy) {
  throw Error(Code::wrong_parameter, concat(what, " ", remedy));
}

}  // namespace

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
    refuse("Parity requires square cells.", "Choose the square lattice, or no parity.");
  }
  if (options.method == Method::lscm) {
    refuse("Least squares conformal maps have no transitions to round.", "Choose the method lsgp.");
  }
  if (options.border == BorderMode::straight) {
    refuse("Straight boundaries cannot be kept in a seamless layout.", "Leave the boundaries free.");
  }
  if (!pins.corners.empty()) {
    throw Error(Code::pins_conflict,
                "Pinned texture coordinates cannot be kept in a seamless layout, which is aligned with a lattice. "
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
             " flipped and ", count(map.validity.wrong_angle_sums.size(), "vertex has", "vertices have"),
             " a wrong angle sum, so there is no valid initial layout. Move or add cones nearby."),
      {ElementKind::vertices, std::move(where)});
}

SeamlessReport make_seamless(const Options& options, double unit_scale, Array<SeamlessComponent>& components,
                             std::vector<Finding>& findings, ProgressMonitor& monitor) {
  for (;;) {
    std::vector<Finding> found;
    try {
      SeamlessReport report = lay_out(options, unit_scale, components, found, monitor);
      findings.insert(findings.end(), found.begin(), found.end());
      return report;
    } catch (const ComponentsFailed& failed) {
      leave_out(failed.failures, components, findings);
    }
  }
}

}  // namespace lsgp
