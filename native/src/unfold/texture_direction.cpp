// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/texture_direction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

const Complex upwards(0, 1);
constexpr double same_uprightness = 1e-9;  // of two turns, relative to the weights
constexpr double least_inside = 1e-9;      // relative component of a direction in its triangle; less is rounding
constexpr double smallest_weight = std::numeric_limits<double>::min();

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

// Whether a direction has a significant component in its triangle's plane.
bool lies_in_triangle(const HalfedgeMesh& mesh, const Positions& vectors, Index f) {
  constexpr double least_part = 0.2;
  const Eigen::Vector3d normal = area_normal(mesh.positions, mesh.triangles, f).normalized();
  const Eigen::Vector3d vector = vectors.row(f).stableNormalized();
  return (vector - normal.dot(vector) * normal).norm() >= least_part;
}

double angle_sum(const HalfedgeMesh& mesh, Index v) {
  double out = 0;
  mesh.for_each_outgoing(v,
                         [&](Index h) { out += angle_between(edge_in_space(mesh, h), -edge_in_space(mesh, prev(h))); });
  return out;
}

std::optional<double> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int rotation_order,
                                     const Array<Index>& loop) {
  constexpr double most_doubt = 0.25;  // of the largest that an angle between directions can be
  const double period = 2 * M_PI / rotation_order;
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
  return length > 0 && std::isfinite(length) ? weight[triangle] * (image / length) : 0;
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
    const double largest = vectors.row(f).cwiseAbs().maxCoeff();
    if (!(largest > 0)) continue;
    const Eigen::Vector3d vector = vectors.row(f).transpose() / largest;
    const Eigen::Vector3d inside = vector - unit.dot(vector) * unit;
    if (!(inside.norm() > least_inside)) continue;
    out.along_first[f] = unit.dot(inside.cross(last)) / doubled_area;
    out.along_last[f] = unit.dot(first.cross(inside)) / doubled_area;
    // A direction of negligible weight still has an error.
    out.weight[f] = std::max(doubled_area / 2 * inside.norm() * (largest / longest), smallest_weight);
  }
  return out;
}

PerLoop<std::optional<double>> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int rotation_order) {
  PerLoop<std::optional<double>> out;
  for (const Array<Index>& loop : mesh.boundary_loops)
    out.push_back(turning_beside(mesh, vectors, rotation_order, loop));
  return out;
}

PerVertex<char> runs_straight_around(const HalfedgeMesh& mesh, const Positions& vectors, int rotation_order) {
  constexpr double largest_bend = M_PI / 8;  // between two triangles
  PerHalfedge<std::optional<double>> angle(mesh.halfedge_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (lies_in_triangle(mesh, vectors, h / 3)) angle[h] = angle_from_direction(mesh, vectors, h);
  }
  const auto is_parallel = [&](Index h) {
    if (!angle[h]) return false;
    const Index twin = mesh.twin[h];
    if (twin == none) return true;
    return angle[twin] &&
           std::abs(std::remainder(*angle[twin] - *angle[h] - M_PI, 2 * M_PI / rotation_order)) <= largest_bend;
  };
  PerVertex<char> out(mesh.vertex_count(), 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_parallel(h)) out[mesh.origin(h)] = out[mesh.target(h)] = 0;
  }
  return out;
}

void UpwardTurn::add(Complex image) {
  const double weight = std::abs(image);
  if (!(weight > 0)) return;
  const double angle = std::arg(image / upwards);
  once_ += std::polar(weight, angle);
  twice_ += std::polar(weight, 2 * angle);
  by_quarter_ += std::polar(weight, 4 * angle);
  by_rotation_ += std::polar(weight, rotation_order_ * angle);
  weight_ += weight;
}

bool UpwardTurn::remains(Complex sum) const {
  constexpr double least_share = 0.2;
  return std::abs(sum) > least_share * weight_;
}

std::optional<Complex> UpwardTurn::turn() const {
  constexpr double least_share = 0.9;  // angles of 6 degrees
  const std::optional<Complex> fitted = fitted_turn();
  if (!fitted || !(std::abs(by_quarter_) > least_share * weight_)) return fitted;
  const Complex frame = std::polar(1.0, -std::arg(by_quarter_) / 4);
  const double quarters = std::round(std::arg(*fitted / frame) / (M_PI / 2));
  return frame * std::polar(1.0, quarters * M_PI / 2);
}

std::optional<Complex> UpwardTurn::fitted_turn() const {
  if (std::abs(once_) >= std::abs(twice_)) {
    if (!remains(once_)) return std::nullopt;
    return std::polar(1.0, -std::arg(once_));
  }
  if (!remains(twice_)) return std::nullopt;
  const Complex turn = std::polar(1.0, -std::arg(twice_) / 2);
  return std::real(once_ * turn) < 0 ? -turn : turn;
}

std::optional<Complex> UpwardTurn::turn_to_lattice() const {
  if (!remains(by_rotation_)) return std::nullopt;
  return std::polar(1.0, -std::arg(by_rotation_) / rotation_order_);
}

int UpwardTurn::turns_on_lattice() const {
  // A texture upside down looks better than one on its side.
  constexpr double share_of_once = 0.1;
  int best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int turns = 0; turns < rotation_order_; ++turns) {
    const double angle = 2 * M_PI * turns / rotation_order_;
    const double upright =
        std::real(twice_ * std::polar(1.0, 2 * angle) + share_of_once * once_ * std::polar(1.0, angle));
    if (!(upright > most + same_uprightness * weight_)) continue;
    most = upright;
    best = turns;
  }
  return best;
}

UpwardTurn upward_turn(const TextureDirections& directions, const CornerPositions& position, int rotation_order) {
  UpwardTurn out(rotation_order);
  for (Index f = 0; f < directions.weight.size(); ++f) out.add(directions.image(position, f));
  return out;
}

double angle_to_v(Complex image, int rotation_order) {
  return std::abs(std::remainder(std::arg(image / upwards), 2 * M_PI / rotation_order));
}

double mean_angle_to_v(const TextureDirections& directions, const CornerPositions& position, int rotation_order) {
  double sum = 0, weight = 0;
  for (Index f = 0; f < directions.weight.size(); ++f) {
    const Complex image = directions.image(position, f);
    sum += std::abs(image) * angle_to_v(image, rotation_order);
    weight += std::abs(image);
  }
  return weight > 0 ? sum / weight : 0;
}

double misalignment_on_lattice(const TextureDirections& directions, const CornerPositions& position,
                               int rotation_order) {
  const Complex turn = upward_turn(directions, position, rotation_order).turn_to_lattice().value_or(1);
  return mean_angle_to_v(directions, position * turn, rotation_order);
}

}  // namespace lsgp
