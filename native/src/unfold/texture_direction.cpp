// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/texture_direction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

const Complex upwards(0, 1);

Eigen::Vector3d edge_in_space(const HalfedgeMesh& mesh, Index h) {
  return mesh.positions.row(mesh.target(h)) - mesh.positions.row(mesh.origin(h));
}

// The angle from the direction in its triangle to a halfedge; none where there is no direction.
std::optional<double> angle_from_direction(const HalfedgeMesh& mesh, const Positions& vectors, Index h) {
  const Eigen::Vector3d normal = area_normal(mesh.positions, mesh.triangles, h / 3).normalized();
  const Eigen::Vector3d vector = vectors.row(h / 3), edge = edge_in_space(mesh, h);
  const double along = vector.dot(edge), across = normal.dot(vector.cross(edge));
  if (!(std::abs(along) + std::abs(across) > 0)) return std::nullopt;
  return std::atan2(across, along);
}

double angle_sum(const HalfedgeMesh& mesh, Index v) {
  double out = 0;
  mesh.for_each_outgoing(v,
                         [&](Index h) { out += angle_between(edge_in_space(mesh, h), -edge_in_space(mesh, prev(h))); });
  return out;
}

std::optional<double> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int symmetry,
                                     const Array<Index>& loop) {
  constexpr double most_doubt = 0.25;  // of the largest that an angle between directions can be
  const double period = 2 * M_PI / symmetry;
  double turning = 0, doubt = 0;
  std::optional<double> before = angle_from_direction(mesh, vectors, mesh.outgoing[loop.back()]);
  for (const Index v : loop) {
    const std::optional<double> after = angle_from_direction(mesh, vectors, mesh.outgoing[v]);
    if (!before || !after) return std::nullopt;
    const double on_surface = M_PI - angle_sum(mesh, v);
    const double turned = std::remainder(*after - *before - on_surface, period);
    turning += on_surface + turned;
    doubt += std::abs(turned);
    before = after;
  }
  if (!(doubt <= most_doubt * period / 2 * static_cast<double>(loop.size()))) return std::nullopt;
  return period * std::round(turning / period);
}

}  // namespace

Complex TextureDirections::image(const CornerPositions& position, Index triangle) const {
  if (!(weight[triangle] > 0)) return 0;
  const Complex corner = position[3 * triangle];
  const Complex image = along_first[triangle] * (position[3 * triangle + 1] - corner) +
                        along_last[triangle] * (position[3 * triangle + 2] - corner);
  const double length = std::abs(image);
  return length > 0 && std::isfinite(length) ? weight[triangle] / length * image : 0;
}

TextureDirections directions_in_triangles(const HalfedgeMesh& mesh, const Positions& vectors) {
  const Index count = mesh.triangle_count();
  TextureDirections out{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  const double longest = vectors.cwiseAbs().maxCoeff();
  if (!(longest > 0)) return out;
  for (Index f = 0; f < count; ++f) {
    const Eigen::Vector3d corner = mesh.positions.row(mesh.triangles(f, 0));
    const Eigen::Vector3d first = mesh.positions.row(mesh.triangles(f, 1)).transpose() - corner;
    const Eigen::Vector3d last = mesh.positions.row(mesh.triangles(f, 2)).transpose() - corner;
    const Eigen::Vector3d normal = first.cross(last);
    const double doubled_area = normal.norm();
    if (!(doubled_area > 0)) continue;
    const Eigen::Vector3d unit = normal / doubled_area;
    const Eigen::Vector3d vector = vectors.row(f).transpose() / longest;
    const Eigen::Vector3d inside = vector - unit.dot(vector) * unit;
    out.along_first[f] = unit.dot(inside.cross(last)) / doubled_area;
    out.along_last[f] = unit.dot(first.cross(inside)) / doubled_area;
    out.weight[f] = doubled_area / 2 * inside.norm();
  }
  return out;
}

Array<std::optional<double>> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int symmetry) {
  Array<std::optional<double>> out;
  double missing = 2 * M_PI * mesh.euler;
  for (const Array<Index>& loop : mesh.boundary_loops) {
    out.push_back(turning_beside(mesh, vectors, symmetry, loop));
    missing -= out.back().value_or(0);
  }
  const bool all = std::all_of(out.begin(), out.end(), [](const auto& turning) { return turning.has_value(); });
  if (all && std::abs(missing) > M_PI / symmetry) out.assign(out.size(), std::nullopt);
  return out;
}

void UpwardTurn::add(Complex image) {
  const double weight = std::abs(image);
  if (!(weight > 0)) return;
  sum_ += weight * std::polar(1.0, symmetry_ * std::arg(image / upwards));
  weight_ += weight;
}

std::optional<Complex> UpwardTurn::turn() const {
  constexpr double least_share = 0.2;  // of the images that has to be left of them
  if (!(std::abs(sum_) > least_share * weight_)) return std::nullopt;
  return std::polar(1.0, -std::arg(sum_) / symmetry_);
}

std::optional<Complex> upward_turn(const TextureDirections& directions, const CornerPositions& position, int symmetry) {
  UpwardTurn sum(symmetry);
  for (Index f = 0; f < directions.weight.size(); ++f) sum.add(directions.image(position, f));
  return sum.turn();
}

double angle_to_v(Complex image, int symmetry) {
  return std::abs(std::remainder(std::arg(image / upwards), 2 * M_PI / symmetry));
}

double mean_angle_to_v(const TextureDirections& directions, const CornerPositions& position, int symmetry) {
  double sum = 0, weight = 0;
  for (Index f = 0; f < directions.weight.size(); ++f) {
    const Complex image = directions.image(position, f);
    sum += std::abs(image) * angle_to_v(image, symmetry);
    weight += std::abs(image);
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace lsgp
