// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/thread_team.hpp"

namespace lsgp {

namespace {

// A triangle counts as degenerate when its height is below this share of its longest edge.
constexpr double degenerate_height = 1e-8;
constexpr double least_margin = 1e-4;  // of triangle inequalities where there are degenerate triangles

Index triangle_count(const Geometry& geometry) { return static_cast<Index>(geometry.area.size()); }

// Twice the area of a triangle with these sides; 0 where there is none (Kahan's stable formula).
double doubled_area_between(const Eigen::Vector3d& sides) {
  double sorted[3] = {sides[0], sides[1], sides[2]};
  std::sort(sorted, sorted + 3, [](double a, double b) { return a > b; });
  const double a = sorted[0], b = sorted[1], c = sorted[2];
  const double square = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return std::sqrt(std::max(square, 0.0)) / 2;
}

// Angles, half cotangents and area of one triangle from its three edge lengths.
void measure_from_lengths(Geometry& geometry, Index f) {
  const double area = geometry.area[f] = doubled_area_between(geometry.length.segment<3>(3 * f)) / 2;
  for (int i = 0; i < 3; ++i) {
    const double opposite = geometry.length[3 * f + i], left = geometry.length[3 * f + (i + 1) % 3],
                 right = geometry.length[3 * f + (i + 2) % 3];
    const double dot = (left * left + right * right - opposite * opposite) / 2;
    geometry.half_cotangent[3 * f + i] = dot / (4 * area);
    geometry.angle[3 * f + (i + 2) % 3] = std::atan2(2 * area, dot);
  }
}

// From the positions.
void measure_from_positions(const HalfedgeMesh& mesh, Geometry& geometry, Index f) {
  Eigen::Vector3d corner[3], edge[3];
  for (int c = 0; c < 3; ++c) corner[c] = mesh.positions.row(mesh.triangles(f, c));
  for (int c = 0; c < 3; ++c) {
    edge[c] = corner[(c + 1) % 3] - corner[c];
    geometry.length[3 * f + c] = edge[c].norm();
  }
  const double doubled_area = edge[0].cross(edge[1]).norm();
  geometry.area[f] = doubled_area / 2;
  for (int c = 0; c < 3; ++c) {
    const double dot = -edge[(c + 1) % 3].dot(edge[(c + 2) % 3]);  // at the corner opposite halfedge c
    geometry.half_cotangent[3 * f + c] = dot / (2 * doubled_area);
    geometry.angle[3 * f + (c + 2) % 3] = std::atan2(doubled_area, dot);
  }
}

// Returns whether the triangle is degenerate.
bool measure(const HalfedgeMesh& mesh, const Eigen::VectorXd& scale, Geometry& geometry, Index f) {
  measure_from_positions(mesh, geometry, f);
  if (scale.size() > 0) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) geometry.length[h] *= edge_scale(scale, mesh.origin(h), mesh.target(h));
    measure_from_lengths(geometry, f);
  }
  const double longest = geometry.length.segment<3>(3 * f).maxCoeff();
  return !(2 * geometry.area[f] > degenerate_height * longest * longest);
}

void measure_from_lengths(Geometry& geometry) {
  for_each_at_once(triangle_count(geometry), [&](Index f) { measure_from_lengths(geometry, f); });
}

// margin: in mean edge lengths.
void mollify(Geometry& geometry, double margin) {
  const double mean = geometry.length.mean();
  double added = 0;
  for (Index h = 0; h < geometry.length.size(); ++h) {
    const double slack = geometry.length[next(h)] + geometry.length[prev(h)] - geometry.length[h];
    added = std::max(added, margin * mean - slack);
  }
  geometry.length.array() += added;
  measure_from_lengths(geometry);
}

void place_apexes(Geometry& geometry) {
  geometry.apex.resize(geometry.area.size());
  for_each_at_once(triangle_count(geometry), [&](Index f) {
    const double height = 2 * geometry.area[f] / geometry.length[3 * f];
    geometry.apex[f] = {2 * height * geometry.half_cotangent[3 * f + 1], height};
  });
}

void add_up_vertices(const HalfedgeMesh& mesh, Geometry& geometry) {
  geometry.vertex_area = Eigen::VectorXd::Zero(mesh.vertex_count());
  geometry.angle_defect.resize(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    geometry.angle_defect[v] = mesh.flat_angle(v);
  }
  for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
    const Index v = mesh.origin(corner);
    geometry.vertex_area[v] += geometry.area[corner / 3] / 3;
    geometry.angle_defect[v] -= geometry.angle[corner];
  }
  geometry.total_area = geometry.area.sum();
}

Geometry unmeasured(const HalfedgeMesh& mesh) {
  Geometry geometry;
  geometry.length.resize(mesh.halfedge_count());
  geometry.angle.resize(mesh.halfedge_count());
  geometry.half_cotangent.resize(mesh.halfedge_count());
  geometry.area.resize(mesh.triangle_count());
  return geometry;
}

// What follows from the measures of the triangles.
Geometry completed(const HalfedgeMesh& mesh, Geometry geometry) {
  place_apexes(geometry);
  add_up_vertices(mesh, geometry);
  return geometry;
}

Geometry build_geometry(const HalfedgeMesh& mesh, const Eigen::VectorXd& scale) {
  Geometry geometry = unmeasured(mesh);
  PerTriangle<char> is_degenerate(mesh.triangle_count());
  for_each_at_once(mesh.triangle_count(), [&](Index f) { is_degenerate[f] = measure(mesh, scale, geometry, f); });
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (is_degenerate[f]) geometry.degenerate.push_back(f);
  }
  if (!geometry.degenerate.empty()) mollify(geometry, least_margin);
  return completed(mesh, std::move(geometry));
}

}  // namespace

Geometry build_geometry(const HalfedgeMesh& mesh) { return build_geometry(mesh, mesh.scale); }

Eigen::VectorXd defects_in_space(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  return mesh.scale.size() == 0 ? surface.geometry.angle_defect : build_geometry(mesh, {}).angle_defect;
}

Geometry mollified(const HalfedgeMesh& mesh, Geometry geometry, double margin) {
  mollify(geometry, margin);
  return completed(mesh, std::move(geometry));
}

Geometry geometry_of_lengths(const HalfedgeMesh& mesh, Eigen::VectorXd length) {
  Geometry geometry = unmeasured(mesh);
  geometry.length = std::move(length);
  measure_from_lengths(geometry);
  return completed(mesh, std::move(geometry));
}

TwoSides two_sides(const Positions& positions, const Triangles& triangles, const Eigen::VectorXd& scale, Index f) {
  Eigen::Vector3d corner[3];
  for (int c = 0; c < 3; ++c) corner[c] = positions.row(triangles(f, c));
  const Eigen::Vector3d first = corner[1] - corner[0], second = corner[2] - corner[0];
  if (scale.size() == 0) return {first.squaredNorm(), first.dot(second), first.cross(second).norm()};
  const auto length = [&](int a, int b) {
    return edge_scale(scale, triangles(f, a), triangles(f, b)) * (corner[b] - corner[a]).norm();
  };
  const Eigen::Vector3d sides(length(0, 1), length(1, 2), length(2, 0)), squares = sides.cwiseAbs2();
  return {squares[0], (squares[0] + squares[2] - squares[1]) / 2, doubled_area_between(sides)};
}

Eigen::Vector3d area_normal(const Positions& positions, const Triangles& triangles, Index f) {
  const Eigen::Vector3d a = positions.row(triangles(f, 0)), b = positions.row(triangles(f, 1));
  const Eigen::Vector3d c = positions.row(triangles(f, 2));
  return (b - a).cross(c - a);
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Vector3d surface_normal(const HalfedgeMesh& mesh, Index f) {
  constexpr double least_height = 1e-4;  // of the longest edge
  constexpr int most_steps = 16;
  const auto squared_length = [&mesh](Index h) {
    return (mesh.positions.row(mesh.target(h)) - mesh.positions.row(mesh.origin(h))).squaredNorm();
  };
  Eigen::Vector3d normal = area_normal(mesh.positions, mesh.triangles, f);
  const auto is_narrow = [&] {
    const double longest = std::max({squared_length(3 * f), squared_length(3 * f + 1), squared_length(3 * f + 2)});
    return !(normal.norm() > least_height * longest);
  };
  Index entered = none;
  for (int step = 0; step < most_steps && is_narrow(); ++step) {
    const auto order = [&](Index h) { return std::make_pair(!mesh.cuttable[h], squared_length(h)); };
    Index across = none;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (h == entered || mesh.twin[h] == none) continue;
      if (across == none || order(h) > order(across)) across = h;
    }
    if (across == none) break;
    entered = mesh.twin[across];
    f = entered / 3;
    normal = area_normal(mesh.positions, mesh.triangles, f);
  }
  return normal;
}

double bend_at(const HalfedgeMesh& mesh, Index h) {
  return angle_between(surface_normal(mesh, h / 3), surface_normal(mesh, mesh.twin[h] / 3));
}

}  // namespace lsgp
