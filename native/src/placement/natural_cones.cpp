// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/natural_cones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/union_find.hpp"
#include "creases/rounds.hpp"
#include "plane/point_lattice.hpp"
#include "prescription/quantize_curvature.hpp"

namespace lsgp {

namespace {

constexpr double angle_of_flat = 1e-5;             // radians of defect: a vertex that is flat but for rounding
constexpr double angle_of_corner = M_PI / 18;      // radians of defect: less is a bend of a smooth surface
constexpr double angle_of_bend = 1e-3;             // radians of defect: a vertex that is not flat on a rounded shape
constexpr std::ptrdiff_t most_bent = 15000;        // edges between vertices of rounded corners
constexpr double least_gap = 2;                    // factor between the lengths of edges in corners and between them
constexpr double angle_off = 0.05;                 // radians that the curvature of rounded corners may be off
constexpr double most_of_corner = 1.75 * M_PI;     // of a cone
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

using VertexSets = Array<Array<Index>>;

// The first choice for bent vertices in sets that are connected by edges much shorter than those between the sets: by
// the shortest edges first, as often as there is such a gap, and at last by all edges.
template <typename Choose>
std::optional<ConeChoice> first_choice_at_gaps(const PlacementTask& task, const Choose& choice_for) {
  const HalfedgeMesh& mesh = task.mesh;
  const auto is_bent = [&](Index v) { return std::abs(task.geometry.angle_defect[v]) >= angle_of_bend; };
  Array<std::pair<double, Index>> edges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] < h && is_bent(mesh.origin(h)) && is_bent(mesh.target(h))) {
      edges.emplace_back(task.geometry.length[h], h);
    }
  }
  if (ssize(edges) > most_bent) return std::nullopt;
  std::sort(edges.begin(), edges.end());
  UnionFind joined(mesh.vertex_count());
  const auto sets = [&] {
    std::map<Index, Array<Index>> found;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (is_bent(v)) found[joined.find(v)].push_back(v);
    }
    VertexSets out;
    for (auto& [first, vertices] : found) out.push_back(std::move(vertices));
    return out;
  };
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& [length, h] : edges) {
    if (joined.find(mesh.origin(h)) == joined.find(mesh.target(h))) continue;
    if (length > least_gap * longest) {
      if (auto choice = choice_for(sets())) return choice;
    }
    joined.unite(mesh.origin(h), mesh.target(h));
    longest = length;
  }
  return choice_for(sets());
}

// The vertex nearest to the center of curvature of these, one in the mirror plane if there are any; none if no cone may
// be at any of them.
Index middle_of(const PlacementTask& task, const Array<Index>& vertices, const PerVertex<char>& possible) {
  const auto is_in_plane = [&](Index v) { return !task.mirrored.empty() && task.mirrored[v] == v; };
  const bool has_plane = std::any_of(vertices.begin(), vertices.end(), is_in_plane);
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
  double whole = 0;
  for (const Index v : vertices) {
    const double bend = std::abs(task.geometry.angle_defect[v]);
    center += bend * task.mesh.positions.row(v);
    whole += bend;
  }
  center /= whole;
  Index out = none;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Index v : vertices) {
    const double distance = (task.mesh.positions.row(v) - center).norm();
    if (!possible[v] || (has_plane && !is_in_plane(v)) || !(distance < nearest)) continue;
    nearest = distance;
    out = v;
  }
  return out;
}

// None if there are too many, or if one has no curvature that a cone or the lattice can have.
std::optional<ConeChoice> cones_in_middles(const ConeChooser& chooser, const VertexSets& corners) {
  const PlacementTask& task = chooser.task();
  const PlacementOptions& options = chooser.options();
  if (corners.empty() || corners.size() > most_natural) return std::nullopt;
  if (options.count && *options.count != static_cast<int>(corners.size())) return std::nullopt;
  const PerVertex<char> possible = find_possible(chooser);
  Array<Index> cones;
  Eigen::VectorXd curvature(static_cast<Eigen::Index>(corners.size()));
  for (const Array<Index>& corner : corners) {
    double& of_corner = curvature[ssize(cones)];
    of_corner = 0;
    for (const Index v : corner) of_corner += task.geometry.angle_defect[v];
    if (std::abs(of_corner) < angle_of_corner || of_corner > most_of_corner) return std::nullopt;
    if (options.lattice) {
      const double rounded = rounded_to(*options.lattice, of_corner);
      if (std::abs(rounded - of_corner) > angle_off) return std::nullopt;
      of_corner = rounded;
    }
    const Index image = task.mirrored.empty() ? none : task.mirrored[corner.front()];
    Index at = none;
    for (Index i = 0; i < ssize(cones); ++i) {
      if (std::binary_search(corners[i].begin(), corners[i].end(), image)) at = task.mirrored[cones[i]];
    }
    if (at == none) at = middle_of(task, corner, possible);
    if (at == none || !possible[at]) return std::nullopt;
    cones.push_back(at);
  }
  const double missing = chooser.scale().required_sum() - curvature.sum();
  if (std::abs(missing) > angle_off) return std::nullopt;
  curvature.array() += missing / static_cast<double>(curvature.size());
  make_symmetric(task.mirrored, cones, curvature);
  return chooser.choice_with(cones, curvature);
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

std::optional<ConeChoice> rounded_corner_cones(const ConeChooser& chooser) {
  const PlacementTask& task = chooser.task();
  if (!task.mesh.closed() || !task.existing.vertices.empty()) return std::nullopt;
  return first_choice_at_gaps(task, [&](const VertexSets& corners) { return cones_in_middles(chooser, corners); });
}

}  // namespace lsgp
