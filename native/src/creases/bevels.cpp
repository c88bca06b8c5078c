// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/bevels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "base/checkpoint.hpp"
#include "base/least_first.hpp"
#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

constexpr double within_face = 0.05;       // radians between triangles of one face
constexpr double least_bend = 0.1;         // radians between faces of a bevel
constexpr double most_bevel_bend = 1.1;    // the same: a chamfer has two edges, each with about half the turn
constexpr double largest_radius = 0.05;    // of a bevel, in square roots of the component's area
constexpr double most_area = 0.4;          // of the component
constexpr double unit_of_turns = 1e-6;     // radians; turns are summed in whole units, so that equal ones tie
constexpr std::int64_t alike = 30000;      // units: turns that differ by less tie as well, as chamfers are never exact
constexpr double operations_a_side = 100;  // of a queue

// The halfedges whose edges satisfy the predicate.
template <typename Is>
PerHalfedge<char> marked(const HalfedgeMesh& mesh, Is is) {
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) out[h] = mesh.twin[h] != none && is(h);
  return out;
}

// Triangles of flat faces that are narrow for how much the surface turns at an edge of theirs.
PerTriangle<char> find_rounded(const MetricMesh& surface, const Eigen::VectorXd& bend) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  PerTriangle<Index> face;
  const Index count = label_parts(mesh, marked(mesh, [&](Index h) { return bend[h] >= within_face; }), face);
  PerPart<double> area(count, 0), perimeter(count, 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) area[face[f]] += geometry.area[f];
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const bool ends = mesh.twin[h] == none || face[mesh.twin[h] / 3] != face[h / 3];
    if (ends) perimeter[face[h / 3]] += geometry.length[h];
  }
  const double reach = largest_radius * std::sqrt(geometry.total_area);
  PerPart<char> is_narrow(count, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == none || bend[h] < least_bend) continue;
    const Index f = face[h / 3];
    // The end of a long face is not narrow, nor is a wide one of small triangles.
    const double width = std::max(2 * geometry.area[h / 3] / geometry.length[h], 2 * area[f] / perimeter[f]);
    if (width < reach * bend[h]) is_narrow[f] = 1;
  }
  PerTriangle<char> out(mesh.triangle_count(), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) out[f] = is_narrow[face[f]];
  return out;
}

// The face beside a bevel to which a polygon is nearest, and by how much the surface turns on the way.
struct Side {
  Index face = none;
  std::int64_t turn = 0;
};

// Faces beside bevels end at creases, where the surface bends by `angle`.
PerTriangle<Side> find_sides(const HalfedgeMesh& mesh, const PerTriangle<char>& is_rounded, const Eigen::VectorXd& bend,
                             double angle) {
  PerTriangle<Index> face;
  label_parts(
      mesh,
      marked(mesh, [&](Index h) { return bend[h] >= angle || is_rounded[h / 3] || is_rounded[mesh.twin[h] / 3]; }),
      face);
  // No cut divides a polygon; the middle of a chamfer would, where its two triangles had different sides.
  PerTriangle<Index> polygon;
  const Index count = label_parts(mesh, marked(mesh, [&](Index h) { return may_cut(mesh, h); }), polygon);
  PerPart<Array<Index>> triangles(count);
  for (Index f = 0; f < mesh.triangle_count(); ++f) triangles[polygon[f]].push_back(f);
  PerTriangle<Side> out(mesh.triangle_count());
  using Entry = std::tuple<std::int64_t, Index, std::int64_t, Index>;  // rounded turn, face, turn, triangle
  LeastFirst<Entry> queue;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (!is_rounded[f]) queue.emplace(0, face[f], 0, f);
  }
  while (!queue.empty()) {
    checkpoint(operations_a_side);
    const auto [rounded, side, turn, f] = queue.top();
    queue.pop();
    if (out[f].face != none) continue;
    for (const Index g : triangles[polygon[f]]) {
      out[g] = {side, turn};
      for (Index h = 3 * g; h < 3 * g + 3; ++h) {
        const Index there = mesh.twin[h] == none ? none : mesh.twin[h] / 3;
        if (there == none || !is_rounded[there] || out[there].face != none || bend[h] > most_bevel_bend) continue;
        const std::int64_t further = turn + std::llround(bend[h] / unit_of_turns);
        queue.emplace(further / alike, side, further, there);
      }
    }
  }
  return out;
}

}  // namespace

std::optional<Bevels> find_bevels(const MetricMesh& surface, const Eigen::VectorXd& bend, double angle) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const PerTriangle<char> is_rounded = find_rounded(surface, bend);
  double area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) area += is_rounded[f] ? geometry.area[f] : 0;
  if (area == 0 || area > most_area * geometry.total_area) return std::nullopt;
  const PerTriangle<Side> side = find_sides(mesh, is_rounded, bend, angle);
  Bevels out;
  const auto is_of_bevel = [&](Index f) { return is_rounded[f] && side[f].face != none; };
  out.is_rounded.assign(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_of_bevel(h / 3)) out.is_rounded[mesh.origin(h)] = 1;
  }
  out.edge = marked(mesh, [&](Index h) {
    const Index f = h / 3, g = mesh.twin[h] / 3;
    return bend[h] <= most_bevel_bend && side[f].face != none && side[g].face != none &&
           (is_of_bevel(f) || is_of_bevel(g));
  });
  out.crease = marked(mesh, [&](Index h) {
    const Side &here = side[h / 3], &there = side[mesh.twin[h] / 3];
    const double turn = bend[h] + unit_of_turns * static_cast<double>(here.turn + there.turn);
    return out.edge[h] && here.face != there.face && turn >= angle;
  });
  return out;
}

}  // namespace lsgp
