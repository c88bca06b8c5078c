// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/texture_direction.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

const Complex upwards(0, 1);

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

void UpwardTurn::add(Complex image) {
  const double weight = std::abs(image);
  if (!(weight > 0)) return;
  sum_ += weight * std::polar(1.0, symmetry_ * std::arg(image / upwards));
  weight_ += weight;
}

std::optional<Complex> UpwardTurn::turn() const {
  constexpr double least_share = 1e-6;  // of the images that may be left of them
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

}  // namespace lsgp
