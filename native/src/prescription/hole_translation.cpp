// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/hole_translation.hpp"

#include <Eigen/LU>
#include <cmath>

#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

// The boundary of a hole in the plane, given by log scale y and curvature kappa, both affine in the unknowns.
struct HoleBorder {
  Eigen::VectorXd length;             // (k) of the edges from vertex to vertex, on the surface
  Eigen::VectorXd y, kappa;           // (k) at the vertices
  Eigen::MatrixXd dy, dkappa;         // (k, unknowns)
  double perimeter = 0;               // at first
  static constexpr int closings = 3;  // of every hole: its turning and its translation, two reals

  Eigen::Index size() const { return length.size(); }
  Eigen::Index after(Eigen::Index i) const { return i + 1 < size() ? i + 1 : 0; }

  // The gap of the boundary and its derivative by the unknowns, (closings) and (closings, unknowns).
  void measure(const Eigen::VectorXd& unknowns, Eigen::Ref<Eigen::VectorXd> missing,
               Eigen::Ref<Eigen::MatrixXd> derivative) const {
    const Eigen::VectorXd scale = y + dy * unknowns, turn = kappa + dkappa * unknowns;
    double direction = 0;
    Eigen::RowVectorXd turned = Eigen::RowVectorXd::Zero(unknowns.size());
    Complex gap = 0;
    Eigen::RowVectorXcd change = Eigen::RowVectorXcd::Zero(unknowns.size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      const Eigen::Index next = after(i);
      // Overlong steps can produce NaN, which std::polar does not accept.
      const Complex edge = length[i] / perimeter * std::exp((scale[i] + scale[next]) / 2) *
                           Complex(std::cos(direction), std::sin(direction));
      gap += edge;
      change += edge * ((dy.row(i) + dy.row(next)) / 2).cast<Complex>() + Complex(0, 1) * edge * turned.cast<Complex>();
      direction += turn[next];
      turned += dkappa.row(next);
    }
    missing << turn.sum() + 2 * M_PI, gap.real(), gap.imag();
    derivative << dkappa.colwise().sum(), change.real(), change.imag();
  }
};

// Newton's method on all boundaries together, with steps halved while the gap does not shrink.
std::optional<Eigen::VectorXd> close_borders(const Array<HoleBorder>& borders, Eigen::Index unknown_count) {
  constexpr int most_steps = 30, most_halvings = 8;
  constexpr double closed = 1e-11;
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(unknown_count), missing(unknown_count), tried_missing(unknown_count);
  Eigen::MatrixXd derivative(unknown_count, unknown_count), tried_derivative(unknown_count, unknown_count);
  const auto measure = [&](const Eigen::VectorXd& at, Eigen::VectorXd& values, Eigen::MatrixXd& derivatives) {
    for (std::size_t j = 0; j < borders.size(); ++j) {
      const auto first = static_cast<Eigen::Index>(j) * HoleBorder::closings;
      borders[j].measure(at, values.segment(first, HoleBorder::closings),
                         derivatives.middleRows(first, HoleBorder::closings));
    }
    return values.norm();
  };
  double distance = measure(unknowns, missing, derivative);
  for (int step = 0; step < most_steps; ++step) {
    if (distance <= closed) return unknowns;
    const Eigen::VectorXd direction = derivative.partialPivLu().solve(-missing);
    double share = 1, tried = distance;
    for (int halving = 0; halving < most_halvings; ++halving) {
      tried = measure(unknowns + share * direction, tried_missing, tried_derivative);
      if (tried < distance) break;
      share /= 2;
    }
    if (!(tried < distance)) return std::nullopt;
    unknowns += share * direction;
    missing.swap(tried_missing);
    derivative.swap(tried_derivative);
    distance = tried;
  }
  return std::nullopt;
}

}  // namespace

Eigen::VectorXd extend_from_borders(const MetricMesh& surface, const LogScale& scale,
                                    const Eigen::VectorXd& on_borders) {
  return on_borders - scale.solve(apply_laplacian(surface, on_borders));
}

std::optional<Eigen::VectorXd> close_translations(const MetricMesh& surface, const LogScale& scale,
                                                  const Array<Index>& holes, const Eigen::VectorXd& log_scale) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Eigen::Index unknown_count = HoleBorder::closings * static_cast<Eigen::Index>(holes.size());
  const Eigen::VectorXd curvature = geometry.angle_defect + apply_laplacian(surface, log_scale);
  Array<HoleBorder> borders;
  Array<Array<double>> direction;  // at the vertices of every border
  for (const Index hole : holes) {
    const Array<Index>& loop = mesh.boundary_loops[hole];
    HoleBorder border;
    border.y = log_scale(loop);
    border.kappa = curvature(loop);
    border.length.resize(border.y.size());
    border.dy.resize(border.y.size(), unknown_count);
    border.dkappa.resize(border.y.size(), unknown_count);
    direction.emplace_back();
    double along = 0;
    for (Eigen::Index i = 0; i < border.size(); ++i) {
      along += border.kappa[i] / 2;
      direction.back().push_back(along);
      along += border.kappa[i] / 2;
      border.length[i] = geometry.length[mesh.outgoing[loop[i]]];
      border.perimeter += border.length[i] * std::exp((border.y[i] + border.y[border.after(i)]) / 2);
    }
    borders.push_back(std::move(border));
  }
  const auto on_border_of = [&](std::size_t j, const Eigen::Vector3d& weight, Eigen::VectorXd& out) {
    const Array<Index>& loop = mesh.boundary_loops[holes[j]];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      out[loop[i]] = weight[0] + weight[1] * std::cos(direction[j][i]) + weight[2] * std::sin(direction[j][i]);
    }
  };
  for (Eigen::Index k = 0; k < unknown_count; ++k) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(mesh.vertex_count());
    on_border_of(static_cast<std::size_t>(k / HoleBorder::closings), Eigen::Vector3d::Unit(k % HoleBorder::closings),
                 change);
    change = extend_from_borders(surface, scale, change);
    const Eigen::VectorXd bend = apply_laplacian(surface, change);
    for (std::size_t j = 0; j < holes.size(); ++j) {
      borders[j].dy.col(k) = change(mesh.boundary_loops[holes[j]]);
      borders[j].dkappa.col(k) = bend(mesh.boundary_loops[holes[j]]);
    }
  }
  const auto unknowns = close_borders(borders, unknown_count);
  if (!unknowns) return std::nullopt;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (std::size_t j = 0; j < holes.size(); ++j) {
    on_border_of(j, unknowns->segment<HoleBorder::closings>(HoleBorder::closings * static_cast<Eigen::Index>(j)),
                 change);
  }
  return log_scale + extend_from_borders(surface, scale, change);
}

}  // namespace lsgp
