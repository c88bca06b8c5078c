// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/cut_paths.hpp"
#include "assembly/divided_seams.hpp"
#include "assembly/doubled_triangles.hpp"
#include "assembly/report_defects.hpp"
#include "assembly/vertex_pairs.hpp"
#include "base/text.hpp"
#include "base/thread_team.hpp"
#include "division/compact_islands.hpp"
#include "pipeline/straightening.hpp"
#include "plane/overlaps.hpp"
#include "plane/predicates.hpp"
#include "repair/straight_sides.hpp"
#include "seamless/exact_layout.hpp"
#include "split/split_map.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// The factor that gives a map the surface's texel density. Scales by total unsigned UV area; of a collapsed map, which
// has hardly any, by the mean growth of lengths, which bounds its size. Needles hardly contribute to either, but would
// dominate the mean square, the Dirichlet energy.
double scale_to_surface(const MetricMesh& surface, const ComponentMap& map) {
  const Geometry& geometry = surface.geometry;
  constexpr double least_share = 0.1;  // of the area of an even map in which lengths grow as much
  const Jacobians jacobians = measure_jacobians(surface, map.cut_mesh, map.position);
  const Eigen::ArrayXd grown = jacobians.f_z.array().abs2(), mirrored = jacobians.f_zbar.array().abs2();
  const double area = (geometry.area.array() * (grown - mirrored).abs()).sum();
  const double growth = (geometry.area.array() * (grown + mirrored).sqrt()).sum() / geometry.total_area;
  const double scale = std::sqrt(1 / std::max(area / geometry.total_area, least_share * growth * growth));
  return std::isfinite(scale) ? scale : 1;
}

Complex nearest_quarter(Complex turn) {
  if (std::abs(turn.real()) >= std::abs(turn.imag())) return turn.real() > 0 ? 1 : -1;
  return {0, turn.imag() > 0 ? 1.0 : -1.0};
}

// The guarantees of seamless layouts hold for coordinates as stored in single precision.
void add_flips_as_stored(const HalfedgeMesh& mesh, const CornerPositions& corners, Validity& validity) {
  const Eigen::VectorXcd stored = corners.unaryExpr([](Complex z) { return as_stored(z); });
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (!(doubled_area(stored, f) > 0)) validity.flipped.push_back(f);
  }
  sort_unique(validity.flipped);
}

}  // namespace

Assembly::Assembly(const Surface& surface, const PerComponent<Component>& components, const Options& options,
                   ProgressMonitor& monitor, Result& result)
    : surface_(surface), components_(components), options_(options), monitor_(monitor), result_(result) {
  result.corner_uv = CornerUv::Constant(3 * surface.triangles.rows(), 2, std::numeric_limits<double>::quiet_NaN());
  result.island.assign(static_cast<std::size_t>(surface.triangles.rows()), none);
  result.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  result.direction_errors =
      Eigen::VectorXd::Constant(surface.directions.rows(), std::numeric_limits<double>::quiet_NaN());
  cone_angle_.assign(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  for (const Component& component : components) {
    for (Index f = 0; f < component.mesh.triangle_count(); ++f) {
      const HalfedgeMesh& mesh = component.mesh;
      surface_area_ += two_sides(mesh.positions, mesh.triangles, mesh.scale, f).doubled_area / 2;
    }
  }
}

void Assembly::divide(const OpenedSurface& opened, const ComponentTask& task, ComponentMap& map) {
  const MetricMesh surface{opened.mesh, opened.geometry};
  const PerHalfedge<char>& seam = opened.mesh.seam;
  const SplitTask splitting{seam, task.cones.mirroring};
  const bool keeps_islands =
      options_.compact == Compactness::off || !map.pins.empty() || std::find(seam.begin(), seam.end(), 1) != seam.end();
  if (!keeps_islands) {
    const SharedSquare square{surface_area_ / options_.square_share, scale_to_surface(surface, map), options_.compact};
    if (compact_islands(opened, splitting.mirroring, square, map)) restore_symmetry(opened, splitting, square, map);
  }
  if (result_.seamless || !(map.natural_l2 > 0)) return;
  const ProgressMonitor::Stage stage(monitor_, "relax");
  const StretchOptions stretch{options_.stretch, task.importance};
  const auto advance = [this] { monitor_.advance(0); };
  if (task.is_strip && !opened.mesh.has_features()) {
    straighten_islands({with_marked_sides(opened.mesh, map), opened.geometry}, SideKinds::of_strip, stretch, advance,
                       map);
    map.release_reasons.clear();
  } else {
    const bool is_plain = !options_.straighten || opened.mesh.closed();
    const SideKinds kinds = is_plain ? SideKinds::marked : SideKinds::with_creases;
    straighten_islands(surface, kinds, stretch, advance, map);
  }
}

void Assembly::add(std::size_t component_index, const ComponentTask& task, const Geometry& geometry, FoundMap mapped,
                   KnownMaps known) {
  const Component& component = components_[component_index];
  ComponentMap& map = mapped.map;
  const OpenedSurface opened{{component.mesh, geometry}, component.mesh.seam};
  const SplitTask splitting{component.mesh.seam, task.cones.mirroring};
  const bool may_split = options_.overlaps == Overlaps::split && !result_.seamless && map.pins.size() < 2;
  // A seamless layout was split before its islands were put onto the lattice; pinned ones keep their position.
  if (may_split && !known.split) {
    try {
      split_map(opened, splitting, monitor_, map);
      known.split = mapped;
    } catch (const Error& error) {
      failures_.push_back(failure_of(component, error));
      return;
    }
  }
  const double square_area = surface_area_ / options_.square_share;
  const std::optional<DividedMap>& divided = known.divided;
  if (may_split && divided && divided->compact == options_.compact && divided->square_area == square_area) {
    map = divided->map;
  } else {
    divide(opened, task, map);
    // Straight sides take long.
    if (may_split && map.natural_l2 > 0) known.divided = DividedMap{map, options_.compact, square_area};
  }
  defects_.pinned = defects_.pinned || map.pins.size() > 1;
  move_findings(component, mapped.findings, result_.warnings);
  added_cuts_.add(component, map);
  one_sided_cuts_.add(component, geometry, task.cones.mirroring, map);
  for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
    result_.log_scale[component.source_vertex[v]] = map.curvature.log_scale[v];
  }
  PerVertex<char> is_flat(component.mesh.vertex_count(), 0);
  for (const Index v : map.flat_cones) {
    is_flat[v] = 1;
    flat_cones_.push_back(component.source_vertex[v]);
  }
  for (const Index v : task.cones.vertices) {
    if (is_flat[v]) continue;
    cone_angle_[component.source_vertex[v]] = component.mesh.flat_angle(v) - map.curvature.at_vertex[v];
  }
  Solved solved;
  solved.component = &component;
  solved.directions = &task.directions;
  solved.map = std::move(map);
  add_islands(geometry, solved);
  solved_.push_back(std::move(solved));
}

void Assembly::require_any() {
  if (solved_.empty() && !failures_.empty()) throw failures_.front().error;
  report_skipped(failures_, result_.warnings);
}

void Assembly::finish(const Cones& cones, const Array<std::pair<Index, Index>>& duplicates, OverlapSearch search) {
  place(arrange(islands_));
  {
    const ProgressMonitor::Stage stage(monitor_, "check");
    for (Solved& solved : solved_) {
      check_in_layout(solved);
      collect_checks(*solved.component, solved.map);
      measure_directions(solved);
      features_.add(*solved.component, solved.map, corners(solved), surface_.positions);
    }
  }
  if (search == OverlapSearch::made) {
    const ProgressMonitor::Stage stage(monitor_, "overlaps");
    find_overlapping();
  }
  Array<Index> triangles;
  for (Index f = 0; f < surface_.triangles.rows(); ++f) {
    if (element(result_.island, f) != none) triangles.push_back(f);
  }
  result_.distortion = measure_triangles(surface_, result_.corner_uv, triangles);
  share_maps(surface_, duplicates, result_);
  add_opened_seams();
  report_flat_cones();
  if (directed_ > 0) result_.direction_error = misalignment_ / directed_;
  added_cuts_.report(result_.warnings);
  one_sided_cuts_.report(result_.warnings);
  result_.features = features_.report(result_.warnings);
  result_.cut_edges = to_vertex_pairs(cut_edges_);
  result_.required_cuts = to_vertex_pairs(required_cuts_);
  for (const Index v : cones.vertices) {
    if (std::isnan(cone_angle_[v])) continue;
    result_.cones.push_back(v);
    result_.cone_angles.push_back(cone_angle_[v]);
  }
  trace_cut_paths(surface_, result_);
  report_defects(options_, std::move(defects_), result_);
}

void Assembly::place(const Array<Similarity>& placement) {
  Eigen::Index corner_count = 0;
  for (Solved& solved : solved_) {
    solved.first_corner = corner_count;
    corner_count += solved.component->mesh.halfedge_count();
  }
  layout_.resize(corner_count);
  for (Solved& solved : solved_) {
    const Component& component = *solved.component;
    solved.turn.assign(solved.island_count, 0);
    for (Index i = 0; i < solved.island_count && !solved.is_in_place; ++i) {
      solved.turn[i] = std::arg(placement[solved.first_island + i].turn);
    }
    const auto move = [&](Index island, Complex z) {
      return solved.is_in_place ? z : placement[solved.first_island + island](solved.scale * z);
    };
    const bool is_whole = solved.island_count == 1;  // its copies are moved just once each
    Eigen::VectorXcd moved = solved.map.position;
    if (is_whole) for_each_at_once(moved.size(), [&](Eigen::Index copy) { moved[copy] = move(0, moved[copy]); });
    for_each_at_once(component.mesh.halfedge_count(), [&](Index corner) {
      Complex z = moved[solved.map.cut_mesh.copy_of_corner[corner]];
      if (!is_whole) z = move(solved.island[corner / 3], z);
      layout_[solved.first_corner + corner] = z;
      result_.corner_uv.row(component.source_corner(corner)) << z.real(), z.imag();
    });
  }
  if (layout_.allFinite()) return;
  throw Error(Code::solver_failed,
              "The scale of the layout varies beyond the range of numbers. Add cones where the surface is stretched "
              "most, or unwrap its components separately.");
}

void Assembly::check_in_layout(Solved& solved) const {
  const HalfedgeMesh& mesh = solved.component->mesh;
  check_triangles(mesh, corners(solved), solved.map);
  if (result_.seamless) add_flips_as_stored(mesh, corners(solved), solved.map.validity);
  if (solved.island_count == 1)
    check_seams(mesh, corners(solved), solved.map);
  else
    check_divided_seams(mesh, {solved.island, solved.turn}, corners(solved), solved.map);
}

void Assembly::collect_checks(const Component& component, const ComponentMap& map) {
  result_.seams = worse(result_.seams, map.seams);
  for (const Index f : map.validity.flipped) result_.flipped.push_back(component.source_triangle[f]);
  for (const Index v : map.validity.wrong_angle_sums) {
    result_.wrong_angle_sums.push_back(component.source_vertex[v]);
  }
  result_.cone_angle_error = std::max(result_.cone_angle_error, map.validity.cone_angle_error);
  for (const Index v : map.validity.inexact_angles) defects_.inexact_angles.push_back(component.source_vertex[v]);
  for (const Index h : map.inexact_seams) {
    defects_.inexact_seams.push_back(component.source_vertex[component.mesh.origin(h)]);
    defects_.inexact_seams.push_back(component.source_vertex[component.mesh.target(h)]);
  }
}

void Assembly::measure_directions(const Solved& solved) {
  const int turns = result_.seamless ? result_.seamless->rotation_order : 1;
  for (Index f = 0; f < solved.directions->weight.size(); ++f) {
    const Complex image = solved.directions->image(corners(solved), f);
    if (image == 0.0) continue;
    const double error = angle_to_v(image, turns);
    result_.direction_errors[solved.component->source_triangle[f]] = error;
    misalignment_ += std::abs(image) * error;
    directed_ += std::abs(image);
  }
}

void Assembly::add_islands(const Geometry& geometry, Solved& solved) {
  const Component& component = *solved.component;
  const ComponentMap& map = solved.map;
  const HalfedgeMesh& mesh = component.mesh;
  PerHalfedge<char> open = mesh.seam;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) open[h] = open[h] || map.cut_graph.is_cut[h];
  solved.island_count = label_parts(mesh, open, solved.island);
  append_ends(component, open, cut_edges_);
  for (const Index h : map.required_cuts) {
    // Islands may have been moved across some.
    if (!open[h]) continue;
    required_cuts_.push_back(component.source_vertex[mesh.origin(h)]);
    required_cuts_.push_back(component.source_vertex[mesh.target(h)]);
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    element(result_.island, component.source_triangle[f]) = island_count_ + solved.island[f];
  }
  island_count_ += solved.island_count;
  solved.is_in_place = map.pins.size() > 1 || result_.seamless;
  if (solved.is_in_place) return;
  solved.scale = scale_to_surface({mesh, geometry}, map);
  solved.first_island = ssize(islands_);
  PerPart<UpwardTurn> upward(solved.island_count);
  if (!solved.directions->empty()) {
    const Eigen::VectorXcd position = at_corners(map.cut_mesh, map.position);
    for (Index f = 0; f < mesh.triangle_count(); ++f)
      upward[solved.island[f]].add(solved.directions->image(position, f));
  }
  PerPart<Array<Index>> copies(solved.island_count);  // of every island
  PerCopy<Index> listed_in(map.cut_mesh.copy_count(), none);
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index copy = map.cut_mesh.copy_of_corner[corner], own = solved.island[corner / 3];
    if (listed_in[copy] == own) continue;
    listed_in[copy] = own;
    copies[own].push_back(copy);
  }
  Array<std::optional<Complex>> axes;
  // Closed components have no sides to be straightened, but those of cubes are straight.
  if (options_.straighten) axes = turns_to_axes(mesh, map.cut_mesh, map.position, solved.island);
  const PerPart<char> has_axis = find_feature_axes(solved);
  for (Index i = 0; i < solved.island_count; ++i) {
    const Array<Index>& own = copies[i];
    Island island{Eigen::VectorXcd(own.size()), upward[i].turn(), std::nullopt, static_cast<Index>(solved_.size())};
    for (std::size_t k = 0; k < own.size(); ++k) {
      island.position[static_cast<Eigen::Index>(k)] = solved.scale * map.position[own[k]];
      if (!map.pins.empty() && own[k] == map.pins.front().copy) {
        island.pin = {static_cast<Eigen::Index>(k), map.pins.front().position};
      }
    }
    if (!axes.empty()) island.axes = axes[i];
    if (has_axis[i]) island.turn = nearest_quarter(island.turn.value_or(1.0));
    islands_.push_back(std::move(island));
  }
}

PerPart<char> Assembly::find_feature_axes(const Solved& solved) {
  const HalfedgeMesh& mesh = solved.component->mesh;
  const CutMesh& cut_mesh = solved.map.cut_mesh;
  PerPart<char> out(solved.island_count, 0);
  for (Index h = 0; mesh.has_features() && h < mesh.halfedge_count(); ++h) {
    if (!mesh.feature[h]) continue;
    const Complex edge =
        solved.map.position[cut_mesh.copy_of_corner[next(h)]] - solved.map.position[cut_mesh.copy_of_corner[h]];
    if (is_along_axis(edge)) out[solved.island[h / 3]] = 1;
  }
  return out;
}

void Assembly::add_opened_seams() {
  Array<std::pair<Index, Index>> sides;  // of borders that are marked, the lower vertex first
  for (const Solved& solved : solved_) {
    const Component& component = *solved.component;
    for (Index h = 0; h < component.mesh.halfedge_count(); ++h) {
      if (component.mesh.twin[h] != none || !component.mesh.seam[h]) continue;
      sides.push_back(std::minmax(component.source_vertex[component.mesh.origin(h)],
                                  component.source_vertex[component.mesh.target(h)]));
    }
  }
  std::sort(sides.begin(), sides.end());
  for (auto side = sides.begin(); side != sides.end();) {
    const auto end = std::upper_bound(side, sides.end(), *side);
    if (end - side > 1) cut_edges_.insert(cut_edges_.end(), {side->first, side->second});
    side = end;
  }
}

void Assembly::report_flat_cones() {
  const auto is_cone = [&](Index v) { return !std::isnan(cone_angle_[v]); };
  sort_unique(flat_cones_);  // a vertex shared by components is listed by each
  flat_cones_.erase(std::remove_if(flat_cones_.begin(), flat_cones_.end(), is_cone), flat_cones_.end());
  if (flat_cones_.empty()) return;
  result_.seamless->flat_cones = flat_cones_;  // angles are rounded for seamless layouts alone
  result_.warnings.push_back(
      {Code::flat_cones,
       concat(count(flat_cones_.size(), "cone", "cones"),
              " came out flat when angles were rounded: ordinary vertices now, which need no cut."),
       {ElementKind::vertices, flat_cones_}});
}

// Overlapping triangles, over all islands.
void Assembly::find_overlapping() {
  PerHalfedge<Index> twin(layout_.size());
  Array<Index> triangle(layout_.size() / 3);
  double area = 0;
  for (const Solved& solved : solved_) {
    const HalfedgeMesh& mesh = solved.component->mesh;
    const Index first = static_cast<Index>(solved.first_corner);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index other = mesh.twin[h];
      const bool runs_on =
          other != none && !solved.map.cut_graph.is_cut[h] && solved.island[h / 3] == solved.island[other / 3];
      twin[first + h] = runs_on ? first + other : none;
    }
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      triangle[first / 3 + f] = solved.component->source_triangle[f];
      area += std::abs(doubled_area(layout_, first / 3 + f)) / 2;
    }
  }
  double shared = 0;
  const PerTriangle<Index> face = number_faces();
  PerTriangle<char> is_flipped(surface_.triangles.rows(), 0);
  for (const Index f : result_.flipped) is_flipped[f] = 1;
  for (const Overlap& overlap : result_.flipped.empty() ? find_overlaps(layout_, twin) : find_overlaps(layout_)) {
    shared += overlap.area;
    const Index first = triangle[overlap.first], second = triangle[overlap.second];
    result_.overlapping.insert(result_.overlapping.end(), {first, second});
    if (face[overlap.first] != face[overlap.second] || is_flipped[first] || is_flipped[second]) continue;
    defects_.on_own_face.insert(defects_.on_own_face.end(), {first, second});
  }
  sort_unique(result_.overlapping);
  sort_unique(defects_.on_own_face);
  result_.overlap_area = shared > 0 ? shared / area : 0;
}

// The face of every triangle of the layout: triangles that no cut may separate form one face.
PerTriangle<Index> Assembly::number_faces() const {
  PerTriangle<Index> out, face;
  Index before = 0;
  for (const Solved& solved : solved_) {
    const Index count = label_parts(solved.component->mesh, solved.component->mesh.cuttable, face);
    for (const Index own : face) out.push_back(before + own);
    before += count;
  }
  return out;
}

}  // namespace lsgp
