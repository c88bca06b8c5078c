// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/rounds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

constexpr double is_flat = 0.01;  // radians between triangles of one face
// Of the bend at an edge of a face: what a face that is not quite flat has inside, and quads of coarse balls.
constexpr double flat_share = 0.125, flat_share_of_shapes = 0.25;
constexpr double most_bend = 1.27;   // radians at an edge of something round: of a tube with five sides
constexpr double most_bends = 1.45;  // of one edge to the next: less than for rims of frustums that bend by most_bend
constexpr double most_widths = 2.5;  // of a face to the next
constexpr double least_round = 0.5;  // of the curvature
constexpr int most_triangles = 32;   // of a face that are crossed
constexpr double side_rounding =
    1e-9;  // of a direction: it may not decide on which side a path through a vertex goes on

double ratio(double a, double b) { return std::max(a, b) / std::min(a, b); }

bool is_convex(const HalfedgeMesh& mesh, Index h) {
  const Index beside = mesh.origin(prev(mesh.twin[h]));
  const Eigen::RowVector3d there = mesh.positions.row(beside) - mesh.positions.row(mesh.origin(h));
  return area_normal(mesh.positions, mesh.triangles, h / 3).dot(there) < 0;
}

struct Crossing {
  Index edge;  // a halfedge of the face
  double width;
};

// The edge of a face that is met from the middle of another one at right angles; none at borders and on large fans.
// Edges that together hardly bend beside the first one are inside a face, as diagonals of quads are that noise has
// twisted; many small bends in a row, as of a barrel, are not.
std::optional<Crossing> cross(const HalfedgeMesh& mesh, const Eigen::VectorXd& bend, Index first, double share) {
  using Vector = Eigen::Vector3d;
  const auto position = [&](Index h) -> Vector { return mesh.positions.row(mesh.origin(h)); };
  const Vector normal = area_normal(mesh.positions, mesh.triangles, first / 3).stableNormalized();
  const Vector middle = (position(first) + position(next(first))) / 2;
  const Vector across = normal.cross(position(next(first)) - position(first)).stableNormalized();
  const double inside = std::max(is_flat, share * bend[first]);
  double turned = 0;
  Index h = first;
  for (int i = 0; i < most_triangles; ++i) {
    const Vector to_apex = position(prev(h)) - middle;
    const bool apex_is_left = across.cross(to_apex).dot(normal) > -side_rounding * to_apex.norm();
    h = apex_is_left ? next(h) : prev(h);
    if (mesh.twin[h] == none) return std::nullopt;
    turned += bend[h] >= is_flat ? bend[h] : 0;
    if (turned >= inside) {
      const Vector edge = position(next(h)) - position(h);
      const double width = (position(h) - middle).cross(edge).dot(normal) / across.cross(edge).dot(normal);
      return Crossing{h, width};
    }
    h = mesh.twin[h];
  }
  return std::nullopt;
}

// On how many sides of an edge the surface goes on bending as it does there, after faces of about one width.
int sides_bent_alike(const HalfedgeMesh& mesh, const Eigen::VectorXd& bend, Index h, double share) {
  if (bend[h] > most_bend) return 0;
  const std::optional<Crossing> here = cross(mesh, bend, h, share), there = cross(mesh, bend, mesh.twin[h], share);
  if (!here || !there || !(ratio(here->width, there->width) <= most_widths)) return 0;
  const bool is_convex_here = is_convex(mesh, h);
  const auto goes_on = [&](Index edge) {
    return ratio(bend[edge], bend[h]) <= most_bends && is_convex(mesh, edge) == is_convex_here;
  };
  return goes_on(here->edge) + goes_on(there->edge);
}

}  // namespace

Eigen::VectorXd bends(const HalfedgeMesh& mesh) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.halfedge_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] > h) out[h] = out[mesh.twin[h]] = bend_at(mesh, h);
  }
  return out;
}

bool is_round(const HalfedgeMesh& mesh, const Eigen::VectorXd& bend, Index h) {
  return sides_bent_alike(mesh, bend, h, flat_share) == 2;
}

bool has_round_shape(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Eigen::VectorXd bend = bends(mesh);
  PerVertex<double> round(mesh.vertex_count(), 0), sharp(mesh.vertex_count(), 0);  // bends of edges, radians
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] < h || bend[h] < is_flat) continue;
    // Beside a pole it bends alike on one side only.
    PerVertex<double>& sum = sides_bent_alike(mesh, bend, h, flat_share_of_shapes) > 0 ? round : sharp;
    sum[mesh.origin(h)] += bend[h];
    sum[mesh.target(h)] += bend[h];
  }
  const Eigen::VectorXd defect = defects_in_space(surface);
  double curvature = 0, of_round = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none) continue;
    const double own = std::abs(defect[v]);
    curvature += own;
    if (round[v] > sharp[v]) of_round += own;
  }
  return of_round > least_round * curvature;
}

}  // namespace lsgp
