// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/natural_cones.hpp"

#include <algorithm>
#include <cmath>

#include "creases/rounds.hpp"
#include "plane/point_lattice.hpp"
#include "prescription/quantize_curvature.hpp"

namespace lsgp {

namespace {

constexpr double angle_of_flat = 1e-5;             // radians of defect: a vertex that is flat but for rounding
constexpr double angle_of_corner = M_PI / 18;      // radians of defect: less is a bend of a smooth surface
constexpr std::size_t most_natural = 32;           // cones
constexpr std::size_t most_natural_on_fine = 64;   // where at most half of the vertices have one
constexpr std::size_t most_natural_on_round = 12;  // those of an icosahedron: round shapes need no more of other cones

// Vertices where existing or other cones may be.
PerVertex<char> find_possible(const ConeChooser& chooser) {
  PerVertex<char> possible(chooser.task().mesh.vertex_count(), 0);
  for (const Site& site : chooser.sites()) {
    for (const Index v : {site.vertex, site.mirrored}) {
      if (v != none) possible[v] = 1;
    }
  }
  return possible;
}

// The interior corners, existing cones first; none if other vertices are bent, or if there are many corners.
std::optional<Array<Index>> find_corners(const ConeChooser& chooser, Corners kind) {
  const PlacementTask& task = chooser.task();
  const PerVertex<char> possible = find_possible(chooser);
  Array<Index> corners = task.existing.vertices;
  PerVertex<char> is_listed(task.mesh.vertex_count(), 0);
  for (const Index v : corners) is_listed[v] = 1;
  std::size_t inside = 0;
  const std::size_t most = kind == Corners::all
                               ? static_cast<std::size_t>(task.mesh.vertex_count() / least_vertices_a_cone)
                               : most_natural_on_fine;
  for (Index v = 0; v < task.mesh.vertex_count(); ++v) {
    if (task.mesh.loop_of_vertex[v] != none) continue;
    ++inside;
    const double defect = std::abs(task.geometry.angle_defect[v]);
    if (defect < angle_of_flat || is_listed[v]) continue;
    const bool is_bend = kind == Corners::sharp && defect < angle_of_corner;
    if (is_bend || !possible[v] || corners.size() >= most) return std::nullopt;
    corners.push_back(v);
  }
  if (kind == Corners::sharp && corners.size() > most_natural && 2 * corners.size() > inside) return std::nullopt;
  return corners;
}

double rounded_to(Lattice lattice, double curvature) {
  const int q = rotation_order(lattice);
  return angle_of_turns(turns_of(curvature, q), q);
}

// Mirror images whose defects differ by rounding get the same one.
void make_symmetric(const PerVertex<Index>& mirrored, const Array<Index>& corners, Eigen::VectorXd& curvature) {
  if (mirrored.empty()) return;
  const Eigen::VectorXd before = curvature;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto image = std::find(corners.begin(), corners.end(), mirrored[corners[i]]);
    if (image == corners.end()) continue;
    const Eigen::Index a = static_cast<Eigen::Index>(i), b = image - corners.begin();
    curvature[a] = (before[a] + before[b]) / 2;
  }
}

}  // namespace

std::optional<ConeChoice> natural_cones(const ConeChooser& chooser, Corners kind) {
  const PlacementTask& task = chooser.task();
  const PlacementOptions& options = chooser.options();
  const std::optional<Array<Index>> corners = find_corners(chooser, kind);
  if (!corners || (options.count && *options.count != static_cast<int>(corners->size()))) return std::nullopt;
  if (!options.count && corners->size() > most_natural_on_round && has_round_shape(task)) return std::nullopt;
  const Eigen::VectorXd given = chooser.given_curvature();
  Eigen::VectorXd curvature(static_cast<Eigen::Index>(corners->size()));
  for (Eigen::Index i = 0; i < curvature.size(); ++i) {
    const Index v = (*corners)[static_cast<std::size_t>(i)];
    curvature[i] = task.geometry.angle_defect[v];
    if (std::abs(given[v] - curvature[i]) > angle_of_flat) return std::nullopt;  // false for NaN, where none is given
    if (!options.lattice) continue;
    const double rounded = rounded_to(*options.lattice, curvature[i]);
    if (std::abs(rounded - curvature[i]) > angle_of_flat) return std::nullopt;
    curvature[i] = rounded;
  }
  make_symmetric(task.mirrored, *corners, curvature);
  if (curvature.size() > 0 && chooser.scale().balanced()) {
    // The rounding errors of flat vertices.
    curvature.array() += (chooser.scale().required_sum() - curvature.sum()) / static_cast<double>(curvature.size());
  }
  return chooser.choice_with(*corners, curvature);
}

}  // namespace lsgp
