// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "overlaps.hpp"
#include "split_map.hpp"
#include "text.hpp"

namespace lsgp {

Assembly::Assembly(const Surface& surface, const std::vector<Component>& components, const Options& options,
                   Monitor& monitor, Result& result)
    : surface_(surface), components_(components), options_(options), monitor_(monitor), result_(result) {
  result.corner_uv = CornerUv::Constant(3 * surface.triangles.rows(), 2, std::numeric_limits<double>::quiet_NaN());
  result.island.assign(surface.triangles.rows(), none);
  result.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  cone_angle_.assign(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
}

void Assembly::add(std::size_t component_index, const ComponentCones& cones, const Geometry& geometry,
                   ComponentMap map) {
  const Component& component = components_[component_index];
  for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
    result_.log_scale[component.source_vertex[v]] = map.curvature.log_scale[v];
  }
  for (const Index v : cones.vertices) {
    cone_angle_[component.source_vertex[v]] = component.mesh.flat_angle(v) - map.curvature.at_vertex[v];
  }
  for (const Index v : map.flat_cones) {
    cone_angle_[component.source_vertex[v]] = std::numeric_limits<double>::quiet_NaN();
  }
  // A seamless layout was split before its parts were put onto the lattice; pinned ones keep their place.
  if (options_.overlaps == Overlaps::split && !result_.seamless && map.pins.size() < 2) {
    split_map(component.mesh, geometry, open_seams(component.mesh), component.mesh.seam, monitor_, map);
  }
  Solved solved;
  solved.component = &component;
  solved.map = std::move(map);
  add_islands(geometry, solved);
  solved_.push_back(std::move(solved));
}

void Assembly::finish(const Cones& cones, const std::vector<std::pair<Index, Index>>& duplicates) {
  place(arrange(islands_));
  {
    const Monitor::Stage stage(monitor_, "check");
    for (Solved& solved : solved_) {
      check_in_layout(solved);
      collect_checks(*solved.component, solved.map);
    }
  }
  {
    const Monitor::Stage stage(monitor_, "overlaps");
    find_overlapping();
  }
  std::vector<Index> triangles;
  for (Index f = 0; f < surface_.triangles.rows(); ++f) {
    if (result_.island[f] != none) triangles.push_back(f);
  }
  result_.distortion = measure_triangles(surface_, result_.corner_uv, triangles);
  for (const auto& [f, original] : duplicates) share_map(f, original);
  name_unmapped(duplicates);
  result_.cut_edges = Eigen::Map<VertexPairs>(cut_edges_.data(), static_cast<Eigen::Index>(cut_edges_.size() / 2), 2);
  for (const Index v : cones.vertices) {
    if (std::isnan(cone_angle_[v])) continue;
    result_.cones.push_back(v);
    result_.cone_angles.push_back(cone_angle_[v]);
  }
  report_defects();
}

void Assembly::place(const std::vector<Similarity>& placement) {
  Eigen::Index corner_count = 0;
  for (Solved& solved : solved_) {
    solved.first_corner = corner_count;
    corner_count += solved.component->mesh.halfedge_count();
  }
  layout_.resize(corner_count);
  for (const Solved& solved : solved_) {
    const Component& component = *solved.component;
    const auto move = [&](Index part, Complex z) {
      return solved.is_in_place ? z : placement[solved.first_island + part](solved.scale * z);
    };
    const bool is_whole = solved.part_count == 1;  // its copies are moved just once each
    Eigen::VectorXcd moved = solved.map.position;
    if (is_whole) moved = moved.unaryExpr([&](Complex z) { return move(0, z); });
    for (Index corner = 0; corner < component.mesh.halfedge_count(); ++corner) {
      Complex z = moved[solved.map.cut_mesh.copy_of_corner[corner]];
      if (!is_whole) z = move(solved.part[corner / 3], z);
      layout_[solved.first_corner + corner] = z;
      result_.corner_uv.row(component.source_corner(corner)) << z.real(), z.imag();
    }
  }
  if (layout_.allFinite()) return;
  throw Error(Code::solver_failed,
              "The layout's sizes differ by more than numbers can hold. Add cones where the surface is stretched most, "
              "or unwrap its parts one by one.");
}

void Assembly::check_in_layout(Solved& solved) const {
  const HalfedgeMesh& mesh = solved.component->mesh;
  check_triangles(mesh, corners(solved), solved.map);
  // Islands of one map were moved one by one; their common cuts are checked as they were before.
  if (solved.part_count == 1)
    check_seams(mesh, corners(solved), solved.map);
  else
    check_seams(mesh, at_corners(solved.map.cut_mesh, solved.map.position), solved.map);
}

void Assembly::collect_checks(const Component& component, const ComponentMap& map) {
  result_.seams = worse(result_.seams, map.seams);
  for (const Index f : map.validity.flipped) result_.flipped.push_back(component.source_triangle[f]);
  for (const Index v : map.validity.wrong_angle_sums) {
    result_.wrong_angle_sums.push_back(component.source_vertex[v]);
  }
  result_.cone_angle_error = std::max(result_.cone_angle_error, map.validity.cone_angle_error);
  // Beside flipped triangles angles are off for that reason alone.
  std::vector<char> excused(component.mesh.vertex_count(), 0);
  for (const Index f : map.validity.flipped) {
    for (int c = 0; c < 3; ++c) excused[component.mesh.triangles(f, c)] = 1;
  }
  for (const Index v : map.validity.inexact_angles) {
    if (!excused[v]) inexact_angles_.push_back(component.source_vertex[v]);
  }
  for (const Index h : map.inexact_seams) {
    inexact_seams_.push_back(component.source_vertex[component.mesh.origin(h)]);
    inexact_seams_.push_back(component.source_vertex[component.mesh.target(h)]);
  }
}

std::vector<char> Assembly::open_seams(const HalfedgeMesh& mesh) const {
  // A seamless layout runs on across seams that were not cut.
  return result_.seamless ? std::vector<char>(mesh.halfedge_count(), 0) : mesh.seam;
}

void Assembly::add_islands(const Geometry& geometry, Solved& solved) {
  const Component& component = *solved.component;
  const ComponentMap& map = solved.map;
  const HalfedgeMesh& mesh = component.mesh;
  std::vector<char> open = open_seams(mesh);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) open[h] = open[h] || map.cut_graph.is_cut[h];
  solved.part_count = label_parts(mesh, open, solved.part);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (!open[h] || twin < h || !(map.cut_graph.is_cut[h] || solved.part[h / 3] != solved.part[twin / 3])) continue;
    cut_edges_.push_back(component.source_vertex[mesh.origin(h)]);
    cut_edges_.push_back(component.source_vertex[mesh.target(h)]);
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    result_.island[component.source_triangle[f]] = island_count_ + solved.part[f];
  }
  island_count_ += solved.part_count;
  solved.is_in_place = map.pins.size() > 1 || result_.seamless;
  if (solved.is_in_place) return;
  solved.scale = map.uv_area > 0 ? std::sqrt(geometry.total_area / map.uv_area) : 1.0;
  solved.first_island = islands_.size();
  std::vector<std::vector<Index>> copies(solved.part_count);  // of every island
  std::vector<Index> listed_in(map.cut_mesh.copy_count(), none);
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index copy = map.cut_mesh.copy_of_corner[corner], part = solved.part[corner / 3];
    if (listed_in[copy] == part) continue;
    listed_in[copy] = part;
    copies[part].push_back(copy);
  }
  for (const std::vector<Index>& own : copies) {
    Island island{Eigen::VectorXcd(own.size()), std::nullopt, static_cast<Index>(solved_.size())};
    for (std::size_t k = 0; k < own.size(); ++k) {
      island.position[static_cast<Eigen::Index>(k)] = solved.scale * map.position[own[k]];
      if (!map.pins.empty() && own[k] == map.pins.front().copy) {
        island.pin = {static_cast<Eigen::Index>(k), map.pins.front().position};
      }
    }
    islands_.push_back(std::move(island));
  }
}

void Assembly::name_unmapped(const std::vector<std::pair<Index, Index>>& duplicates) {
  for (Finding& finding : result_.warnings) {
    if (finding.code != Code::component_skipped) continue;
    std::vector<Index>& skipped = finding.elements.indices;
    const std::vector<Index> originals = skipped;  // sorted, as a component lists its triangles
    for (const auto& [f, original] : duplicates) {
      if (std::binary_search(originals.begin(), originals.end(), original)) skipped.push_back(f);
    }
    std::sort(skipped.begin(), skipped.end());
  }
}

void Assembly::share_map(Index triangle, Index original) {
  result_.island[triangle] = result_.island[original];
  for (Index corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
    for (Index other = 3 * original; other < 3 * original + 3; ++other) {
      if (surface_.triangles.data()[corner] == surface_.triangles.data()[other]) {
        result_.corner_uv.row(corner) = result_.corner_uv.row(other);
      }
    }
  }
}

// Triangles that lie on others, over all islands.
void Assembly::find_overlapping() {
  std::vector<Index> twin(layout_.size()), triangle(layout_.size() / 3);
  double area = 0;
  for (const Solved& solved : solved_) {
    const HalfedgeMesh& mesh = solved.component->mesh;
    const Index first = static_cast<Index>(solved.first_corner);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index other = mesh.twin[h];
      const bool runs_on =
          other != none && !solved.map.cut_graph.is_cut[h] && solved.part[h / 3] == solved.part[other / 3];
      twin[first + h] = runs_on ? first + other : none;
    }
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      triangle[first / 3 + f] = solved.component->source_triangle[f];
      area += std::abs(doubled_area(layout_, first / 3 + f)) / 2;
    }
  }
  double shared = 0;
  for (const Overlap& overlap : result_.flipped.empty() ? find_overlaps(layout_, twin) : find_overlaps(layout_)) {
    shared += overlap.area;
    result_.overlapping.insert(result_.overlapping.end(), {triangle[overlap.first], triangle[overlap.second]});
  }
  std::vector<Index>& overlapping = result_.overlapping;
  std::sort(overlapping.begin(), overlapping.end());
  overlapping.erase(std::unique(overlapping.begin(), overlapping.end()), overlapping.end());
  result_.overlap_area = shared > 0 ? shared / area : 0;
}

void Assembly::report_defects() {
  std::vector<Index>& flipped = result_.flipped;
  std::vector<Index>& wrong = result_.wrong_angle_sums;
  std::sort(flipped.begin(), flipped.end());
  std::sort(wrong.begin(), wrong.end());
  const bool foretold = std::any_of(result_.warnings.begin(), result_.warnings.end(),
                                    [](const Finding& finding) { return finding.code == Code::high_distortion; });
  if (!foretold && flipped.empty() && !(result_.distortion.l2_stretch < high_l2)) {
    result_.warnings.push_back({Code::high_distortion,
                                concat("The map stretches much: its L2 stretch is ", result_.distortion.l2_stretch,
                                       ", 1 being none. Add cones where the texture becomes too small."),
                                {}});
  }
  if (!inexact_seams_.empty()) {
    result_.warnings.push_back(
        {Code::inexact_seams,
         concat("At ", count(inexact_seams_.size() / 2, "cut edge", "cut edges"),
                " the two sides agree to fewer than nine digits, because the layout shrinks too much there. Add cones "
                "nearby."),
         {ElementKind::edges, inexact_seams_}});
  }
  if (!inexact_angles_.empty()) {
    std::sort(inexact_angles_.begin(), inexact_angles_.end());
    result_.warnings.push_back({Code::inexact_angles,
                                concat("The angles around ", count(inexact_angles_.size(), "vertex", "vertices"),
                                       " miss what was imposed by more than a millionth. Add cones nearby."),
                                {ElementKind::vertices, inexact_angles_}});
  }
  if (!flipped.empty()) {
    result_.warnings.push_back({Code::flipped_triangles,
                                concat(count(flipped.size(), "triangle is", "triangles are"),
                                       " flipped in the layout. Add a cone nearby or improve the mesh there."),
                                {ElementKind::triangles, flipped}});
  }
  if (!wrong.empty()) {
    result_.warnings.push_back({Code::wrong_angle_sums,
                                concat("At ", count(wrong.size(), "vertex", "vertices"),
                                       " the layout turns once too often or too little. Move or add cones nearby."),
                                {ElementKind::vertices, wrong}});
  }
  report_overlapping();
}

void Assembly::report_overlapping() {
  const std::vector<Index>& overlapping = result_.overlapping;
  if (overlapping.empty()) return;
  const char* remedy = options_.overlaps == Overlaps::keep
                           ? "To bake onto it, choose to split overlaps."
                           : "They could not be split: unpin corners, or improve the mesh where triangles are flipped.";
  result_.warnings.push_back(
      {Code::overlapping_triangles,
       concat(count(overlapping.size(), "triangle lies", "triangles lie"), " on others in the layout. ", remedy),
       {ElementKind::triangles, overlapping}});
}

}  // namespace lsgp
