// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/bevels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
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

// The extent of flat faces across their edges, from the vertices that are outermost in thirteen directions and those
// opposite to them: the corners of strips are among these.
class Extents {
 public:
  Extents(const HalfedgeMesh& mesh, const PerTriangle<Index>& face, Index count) : mesh_(mesh), outermost_(count) {
    Array<Eigen::RowVector3d> directions;
    for (int code = 14; code < 27; ++code) {  // one of each pair of opposite ones
      directions.emplace_back(code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
    }
    for (auto& of_face : outermost_) of_face.fill(none);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index v = mesh.origin(h);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const double at = directions[i].dot(mesh.positions.row(v));
        for (const int sign : {1, -1}) {
          Index& best = outermost_[face[h / 3]][2 * i + (sign < 0)];
          if (best == none || sign * at > sign * directions[i].dot(mesh.positions.row(best))) best = v;
        }
      }
    }
  }

  // Of the face of h.
  double across(Index h, Index face) const {
    const auto at = [&](Index v) -> Eigen::RowVector3d { return mesh_.positions.row(v); };
    const Eigen::RowVector3d along = at(mesh_.target(h)) - at(mesh_.origin(h));
    // The triangle itself may be a sliver.
    const Eigen::RowVector3d across = surface_normal(mesh_, h / 3).transpose().cross(along).stableNormalized();
    if (across.isZero(0)) return std::numeric_limits<double>::infinity();
    double least = 0, most = 0;
    for (const Index v : outermost_[face]) {
      const double here = (at(v) - at(mesh_.origin(h))).dot(across);
      least = std::min(least, here);
      most = std::max(most, here);
    }
    return most - least;
  }

 private:
  const HalfedgeMesh& mesh_;
  PerPart<std::array<Index, 26>> outermost_;
};

// Triangles of flat faces that are narrow for how much the surface turns at an edge of theirs.
PerTriangle<char> find_rounded(const MetricMesh& surface, const Eigen::VectorXd& bend) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  PerTriangle<Index> face;
  const Index count = label_parts(mesh, marked(mesh, [&](Index h) { return bend[h] >= within_face; }), face);
  const Extents extents(mesh, face, count);
  const double reach = largest_radius * std::sqrt(geometry.total_area);
  PerPart<char> is_narrow(count, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    // A sharp edge, such as the rim of a bore, rounds nothing.
    if (mesh.twin[h] == none || bend[h] < least_bend || bend[h] > most_bevel_bend) continue;
    // The end of a long face is not narrow, nor is a wide one of small triangles or slivers.
    const double height = 2 * geometry.area[h / 3] / geometry.length[h];
    if (height < reach * bend[h] && extents.across(h, face[h / 3]) < reach * bend[h]) is_narrow[face[h / 3]] = 1;
  }
  PerTriangle<char> out(mesh.triangle_count(), 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) out[f] = is_narrow[face[f]];
  return out;
}

// The face beside a bevel to which a polygon is nearest, and by how much the surface turns on the way.
struct Side {
  Index face = none;
  std::int64_t turn = 0;
  Index nearest = none;  // triangle of that face
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
  using Entry =
      std::tuple<std::int64_t, Index, std::int64_t, Index, Index>;  // rounded turn, face, turn, triangle, nearest
  LeastFirst<Entry> queue;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (!is_rounded[f]) queue.emplace(0, face[f], 0, f, f);
  }
  while (!queue.empty()) {
    checkpoint(operations_a_side);
    const auto [rounded, side, turn, f, nearest] = queue.top();
    queue.pop();
    if (out[f].face != none) continue;
    for (const Index g : triangles[polygon[f]]) {
      out[g] = {side, turn, nearest};
      for (Index h = 3 * g; h < 3 * g + 3; ++h) {
        const Index there = mesh.twin[h] == none ? none : mesh.twin[h] / 3;
        if (there == none || !is_rounded[there] || out[there].face != none || bend[h] > most_bevel_bend) continue;
        const std::int64_t further = turn + std::llround(bend[h] / unit_of_turns);
        queue.emplace(further / alike, side, further, there, nearest);
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
    if (!out.edge[h] || turn < angle) return false;
    // A face may run on around the end of a bevel, or of the crease of two bores that meet.
    return here.face != there.face ||
           angle_between(surface_normal(mesh, here.nearest), surface_normal(mesh, there.nearest)) >= angle;
  });
  return out;
}

}  // namespace lsgp
