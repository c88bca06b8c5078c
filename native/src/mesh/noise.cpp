// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/noise.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/thread_team.hpp"

namespace lsgp {

namespace {

constexpr Index least_triangles = 500;  // fewer have no scale beside that of the shape
constexpr double most_left = 0.25;      // of the curvature, within two edges
constexpr int edges_around = 2;
constexpr double hardly_bent = 0.1;   // of the root mean square of all bends
constexpr double most_flat = 0.25;    // of the edges: in hard surfaces half of them or more are inside faces
constexpr double same_side = 0.4;     // between unit normals: what bends by twice as much is a crease
constexpr double noise_beside = 0.6;  // at least, of the root mean square of all bends
constexpr int usual_smoothings = 3, most_smoothings = 12;
constexpr int turns_each = 20, moves_each = 10;
constexpr double operations_a_triangle = 100;

// Each vertex divides its value among itself and its neighbors.
Eigen::VectorXd spread(const HalfedgeMesh& mesh, const Eigen::VectorXd& value) {
  PerVertex<Index> sharing(mesh.vertex_count(), 1);
  const auto for_each_pair = [&mesh](auto visit) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      visit(mesh.origin(h), mesh.target(h));
      if (mesh.twin[h] == none) visit(mesh.target(h), mesh.origin(h));
    }
  };
  for_each_pair([&](Index from, Index) { ++sharing[from]; });
  Eigen::VectorXd share(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) share[v] = value[v] / sharing[v];
  Eigen::VectorXd out = share;
  for_each_pair([&](Index from, Index to) { out[to] += share[from]; });
  return out;
}

Positions unit_normals(const HalfedgeMesh& mesh) {
  Positions out(mesh.triangle_count(), 3);
  for_each_at_once(mesh.triangle_count(),
                   [&](Index f) { out.row(f) = surface_normal(mesh, f).stableNormalized().transpose(); });
  return out;
}

// Distances between the unit normals on both sides of inner edges, which are their bends where these are small.
Array<double> squared_bends(const HalfedgeMesh& mesh, const Positions& normal) {
  Array<double> out;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] > h) out.push_back((normal.row(h / 3) - normal.row(mesh.twin[h] / 3)).squaredNorm());
  }
  return out;
}

double mean(const Array<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Of inner edges, those at which the surface hardly bends.
double share_of_flat_edges(const HalfedgeMesh& mesh) {
  const Array<double> bends = squared_bends(mesh, unit_normals(mesh));
  const double most = hardly_bent * hardly_bent * mean(bends);
  const auto flat = std::count_if(bends.begin(), bends.end(), [&](double bend) { return bend <= most; });
  return static_cast<double>(flat) / static_cast<double>(bends.size());
}

// Normals become those of triangles beside them that are on the same side of creases (bilateral filter).
void smooth(const HalfedgeMesh& mesh, const Eigen::VectorXd& area, Positions& normal) {
  const double side = std::max(same_side * same_side, noise_beside * noise_beside * mean(squared_bends(mesh, normal)));
  Positions turned(normal.rows(), 3);
  for (int i = 0; i < turns_each; ++i) {
    for_each_at_once(mesh.triangle_count(), [&](Index f) {
      const Eigen::RowVector3d own = normal.row(f);
      Eigen::RowVector3d sum = area[f] * own;
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (mesh.twin[h] == none) continue;
        const Index g = mesh.twin[h] / 3;
        const Eigen::RowVector3d beside = normal.row(g);
        sum += area[g] * std::exp((own.dot(beside) - 1) / side) * beside;
      }
      turned.row(f) = sum.stableNormalized();
    });
    std::swap(normal, turned);
    checkpoint(operations_a_triangle * mesh.triangle_count());
  }
}

// Vertices move toward the planes through the centers of their triangles (Sun et al. 2007).
void move_toward(const Positions& normal, HalfedgeMesh& mesh) {
  Positions center(mesh.triangle_count(), 3);
  for (int i = 0; i < moves_each; ++i) {
    for_each_at_once(mesh.triangle_count(), [&](Index f) {
      center.row(f) = (mesh.positions.row(mesh.triangles(f, 0)) + mesh.positions.row(mesh.triangles(f, 1)) +
                       mesh.positions.row(mesh.triangles(f, 2))) /
                      3;
    });
    for_each_at_once(mesh.vertex_count(), [&](Index v) {
      const Eigen::RowVector3d at = mesh.positions.row(v);
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      int count = 0;
      mesh.for_each_outgoing(v, [&](Index h) {
        const Eigen::RowVector3d direction = normal.row(h / 3);
        sum += direction.dot(center.row(h / 3) - at) * direction;
        ++count;
      });
      mesh.positions.row(v) += sum / count;
    });
    checkpoint(operations_a_triangle * mesh.triangle_count());
  }
}

}  // namespace

bool is_noisy(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  if (mesh.triangle_count() < least_triangles) return false;
  Eigen::VectorXd curvature = defects_in_space(surface);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none) curvature[v] = 0;
  }
  const double all = curvature.cwiseAbs().sum();
  for (int i = 0; i < edges_around; ++i) curvature = spread(mesh, curvature);
  return curvature.cwiseAbs().sum() < most_left * all && share_of_flat_edges(mesh) < most_flat;
}

Shape::Shape(const MetricMesh& surface, bool without_noise) : surface_(surface) {
  if (!without_noise || !is_noisy(surface)) return;
  Smoothed& out = smoothed_.emplace(Smoothed{surface.mesh, surface.geometry});
  for (int i = 0; i < most_smoothings; ++i) {
    if (i >= usual_smoothings && !is_noisy({out.mesh, out.geometry})) break;
    Positions normal = unit_normals(out.mesh);
    Eigen::VectorXd area(out.mesh.triangle_count());
    for (Index f = 0; f < out.mesh.triangle_count(); ++f) {
      area[f] = area_normal(out.mesh.positions, out.mesh.triangles, f).norm();
    }
    smooth(out.mesh, area, normal);
    move_toward(normal, out.mesh);
    out.geometry = build_geometry(out.mesh);
  }
}

}  // namespace lsgp
