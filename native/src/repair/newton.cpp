// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/checkpoint.hpp"
#include "base/thread_team.hpp"
#include "lsgp/errors.hpp"

namespace lsgp {

namespace {

constexpr double smallest_epsilon = 1e-3;
constexpr double ridge = 1e-9;         // of the diagonal
constexpr double barrier_share = 0.9;  // of the step at which the first triangle would collapse

constexpr std::ptrdiff_t shapes_at_once = 32768;  // whose derivatives are kept until they are added up
constexpr double operations_a_derivative = 10;

}  // namespace

Array<Index> first_rows(const DegreesOfFreedom& freedom) {
  Array<Index> out(freedom.displacement.unknown_count + 1, 0);
  for (Index k = 0; k < freedom.displacement.unknown_count; ++k) {
    const bool is_real = !freedom.is_real.empty() && freedom.is_real[k];
    out[k + 1] = out[k] + (is_real ? 1 : 2);
  }
  return out;
}

DegreesOfFreedom free_vertices(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Eigen::VectorXcd& motion,
                               const PerVertex<char>& marked) {
  DegreesOfFreedom out;
  PerVertex<Index> unknown(mesh.vertex_count(), none);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (marked[v]) unknown[v] = out.displacement.unknown_count++;
  }
  out.displacement.begin.assign(1, 0);
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    const Index of_vertex = unknown[cut_mesh.source[copy]];
    if (of_vertex != none) out.displacement.terms.push_back({of_vertex, motion[copy]});
    out.displacement.begin.push_back(static_cast<Index>(out.displacement.terms.size()));
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const auto moves = [&](int c) { return unknown[mesh.triangles(f, c)] != none; };
    if (moves(0) || moves(1) || moves(2)) out.triangles.push_back(f);
  }
  return out;
}

DegreesOfFreedom free_all(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Reduction& reduction,
                          const PerVertex<char>& fixed) {
  Array<Index> row(reduction.unknown_count, 0);
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    if (!fixed[cut_mesh.source[copy]]) continue;
    reduction.for_each_term(copy, [&](const Term& term) { row[term.unknown] = none; });
  }
  DegreesOfFreedom out;
  for (Index& unknown : row) {
    if (unknown != none) unknown = out.displacement.unknown_count++;
  }
  out.displacement.begin.assign(1, 0);
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    reduction.for_each_term(copy, [&](const Term& term) {
      if (row[term.unknown] != none) out.displacement.terms.push_back({row[term.unknown], term.coefficient});
    });
    out.displacement.begin.push_back(static_cast<Index>(out.displacement.terms.size()));
  }
  out.triangles.resize(mesh.triangle_count());
  std::iota(out.triangles.begin(), out.triangles.end(), 0);
  return out;
}

PerVertex<char> mark_around(const HalfedgeMesh& mesh, const Array<Index>& triangles, int rings) {
  PerVertex<char> inside(mesh.vertex_count(), 0);
  Array<Index> front;
  const auto reach = [&](Index v, Array<Index>& reached) {
    if (inside[v]) return;
    inside[v] = 1;
    reached.push_back(v);
  };
  for (const Index f : triangles) {
    for (int c = 0; c < 3; ++c) reach(mesh.triangles(f, c), front);
  }
  for (int ring = 1; ring < rings; ++ring) {
    Array<Index> reached;
    for (const Index v : front) {
      mesh.for_each_outgoing(v, [&](Index h) {
        reach(mesh.target(h), reached);
        reach(mesh.origin(prev(h)), reached);
      });
    }
    front = std::move(reached);
  }
  return inside;
}

NewtonMinimizer::NewtonMinimizer(const CutSurface& surface, const RestShapes& rest, DegreesOfFreedom freedom,
                                 StepHook before_step, Eigen::VectorXcd& position)
    : first_row_(first_rows(freedom)),
      displacement_(std::move(freedom.displacement)),
      before_step_(std::move(before_step)),
      position_(position),
      hessian_(first_row_.back()) {
  for (Index copy = 0; copy < displacement_.copy_count(); ++copy) {
    if (displacement_.begin[copy] < displacement_.begin[copy + 1]) moving_.push_back(copy);
  }
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const Eigen::VectorXd& log_scale = rest.log_scale;
  shapes_.reserve(freedom.triangles.size());
  for (const Index f : freedom.triangles) {
    const double scale = std::exp(
        (log_scale[mesh.triangles(f, 0)] + log_scale[mesh.triangles(f, 1)] + log_scale[mesh.triangles(f, 2)]) / 3);
    Shape shape;
    shape.triangle = f;
    shape.weight = geometry.area[f];
    shape.begin = static_cast<Index>(slopes_.size());
    for (int c = 0; c < 3; ++c) {
      // f_z = sum g_j z_j and f_zbar = sum h_j z_j with g = -i conj(e) / (4 A), h = i e / (4 A), e opposite corner j;
      // a rotation of f_zbar changes no energy.
      const Complex edge = edge_vector(geometry, next(3 * f + c)) / (4 * geometry.area[f] * scale);
      shape.g[c] = std::polar(1.0, -rest.frames[f]) * Complex(0, -1) * std::conj(edge);
      shape.h[c] = Complex(0, 1) * edge;
      shape.copy[c] = surface.cut_mesh.copy_of_corner[3 * f + c];
      displacement_.for_each_term(shape.copy[c], [&](const Term& term) {
        add_slope(shape.begin, {term.unknown, shape.g[c] * term.coefficient, shape.h[c] * term.coefficient});
      });
    }
    shape.end = static_cast<Index>(slopes_.size());
    shapes_.push_back(shape);
  }
}

void NewtonMinimizer::weigh(const Eigen::VectorXd& factors) {
  for (Shape& shape : shapes_) shape.weight *= factors[shape.triangle];
}

bool NewtonMinimizer::unfold(DistortionEnergy::Kind kind, int most_steps) {
  DistortionEnergy energy{kind};
  double lowest = smallest_determinant(energy);
  energy.epsilon = std::max(smallest_epsilon, -lowest);
  for (int step = 0; step < most_steps && !(lowest > 0); ++step) {
    before_step_();
    const double before = total(energy);
    const auto direction = newton_direction(energy);
    double after = before;
    if (!direction || !search(energy, *direction, 1, before, after)) return false;
    lowest = smallest_determinant(energy);
    // Garanzha et al. 2021, equation (7): epsilon falls as fast as the energy does, but here at least by half.
    const double decrease = std::max(0.5, 1 - after / before);
    const double mu = (1 - decrease) * foldover_chi(lowest, energy.epsilon);
    if (lowest < mu) energy.epsilon = std::max(2 * std::sqrt(mu * (mu - lowest)), std::numeric_limits<double>::min());
  }
  return lowest > 0;
}

void NewtonMinimizer::smooth(DistortionEnergy::Kind barrier, int steps, double least_share) {
  const DistortionEnergy energy{barrier};
  for (int step = 0; step < steps; ++step) {
    before_step_();
    const double before = total(energy);
    const auto direction = newton_direction(energy);
    if (!direction) return;
    double after = before;
    if (!search(energy, *direction, std::min(1.0, barrier_share * collapse_step(*direction)), before, after)) return;
    if (before - after < least_share * before) return;
  }
}

void NewtonMinimizer::add_slope(Index begin, const Slope& slope) {
  for (Eigen::Index i = begin; i < ssize(slopes_); ++i) {
    if (slopes_[i].unknown != slope.unknown) continue;
    slopes_[i].f_z += slope.f_z;
    slopes_[i].f_zbar += slope.f_zbar;
    return;
  }
  slopes_.push_back(slope);
}

template <typename Of>
Array<double> NewtonMinimizer::of_shapes(Of of) const {
  Array<double> out(shapes_.size());
  for_each_at_once(ssize(shapes_), [&](std::ptrdiff_t i) { out[i] = of(shapes_[i]); });
  return out;
}

NewtonMinimizer::Jacobian NewtonMinimizer::jacobian(const Shape& shape) const {
  Jacobian out{0, 0};
  for (int c = 0; c < 3; ++c) {
    out.f_z += shape.g[c] * position_[shape.copy[c]];
    out.f_zbar += shape.h[c] * position_[shape.copy[c]];
  }
  return out;
}

NewtonMinimizer::Jacobian NewtonMinimizer::change(const Shape& shape, const Eigen::VectorXcd& direction) const {
  Jacobian out{0, 0};
  for (Index i = shape.begin; i < shape.end; ++i) {
    out.f_z += slopes_[i].f_z * direction[slopes_[i].unknown];
    out.f_zbar += slopes_[i].f_zbar * direction[slopes_[i].unknown];
  }
  return out;
}

double NewtonMinimizer::smallest_determinant(const DistortionEnergy& energy) const {
  double lowest = std::numeric_limits<double>::infinity();
  const auto determinant = [&](const Shape& shape) {
    const Jacobian at = jacobian(shape);
    return energy.determinant(at.f_z, at.f_zbar);
  };
  for (const double one : of_shapes(determinant)) lowest = std::min(lowest, one);
  return lowest;
}

double NewtonMinimizer::total(const DistortionEnergy& energy) const {
  const auto value = [&](const Shape& shape) {
    const Jacobian at = jacobian(shape);
    return shape.weight * energy.value(at.f_z, at.f_zbar);
  };
  const Array<double> values = of_shapes(value);
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::ptrdiff_t NewtonMinimizer::derivative_size(const Shape& shape) {
  const std::ptrdiff_t unknowns = shape.end - shape.begin;
  return 2 * unknowns + 2 * unknowns * (unknowns + 1);
}

void NewtonMinimizer::differentiate(const DistortionEnergy& energy, const Shape& shape, double* out) const {
  const Jacobian at = jacobian(shape);
  const EnergyExpansion expansion = energy.expand(at.f_z, at.f_zbar);
  // Real form of (f_z, f_zbar) as functions of an unknown.
  const auto map_of = [&](Index slope) {
    const Complex a = slopes_[slope].f_z, b = slopes_[slope].f_zbar;
    Eigen::Matrix<double, 4, 2> map;
    map << a.real(), -a.imag(), a.imag(), a.real(), b.real(), -b.imag(), b.imag(), b.real();
    return map;
  };
  for (Index i = shape.begin; i < shape.end; ++i, out += 2) {
    Eigen::Map<Eigen::Vector2d>{out} = shape.weight * map_of(i).transpose() * expansion.gradient;
  }
  for (Index i = shape.begin; i < shape.end; ++i) {
    const Eigen::Matrix<double, 2, 4> left = shape.weight * map_of(i).transpose() * expansion.hessian;
    for (Index j = shape.begin; j <= i; ++j, out += 4) Eigen::Map<Eigen::Matrix2d>{out} = left * map_of(j);
  }
}

template <typename Add>
void NewtonMinimizer::add_derivatives(const Shape& shape, const double* derivatives, Eigen::VectorXd& gradient,
                                      const Add& add) const {
  const double* slope = derivatives;
  const double* block = derivatives + 2 * (shape.end - shape.begin);
  for (Index i = shape.begin; i < shape.end; ++i, slope += 2) {
    const auto [row, rows] = rows_of(slopes_[i].unknown);
    for (int k = 0; k < rows; ++k) gradient[row + k] += slope[k];
    for (Index j = shape.begin; j <= i; ++j, block += 4) {
      const auto [column, columns] = rows_of(slopes_[j].unknown);
      const Eigen::Map<const Eigen::Matrix2d> bend(block);
      for (int k = 0; k < rows; ++k) {
        const int end = i == j ? k + 1 : columns;  // the lower triangle
        for (int l = 0; l < end; ++l)
          add(row + k, column + l, i == j && k == l ? (1 + ridge) * bend(k, l) : bend(k, l));
      }
    }
  }
}

std::optional<Eigen::VectorXcd> NewtonMinimizer::newton_direction(const DistortionEnergy& energy) {
  const Index count = displacement_.unknown_count;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(first_row_.back());
  // Computed on all threads, and added up in the order of the triangles.
  const auto add_up = [&](const auto& add) {
    for (std::ptrdiff_t begin = 0; begin < ssize(shapes_); begin += shapes_at_once) {
      const Shape* some = shapes_.data() + begin;
      const std::ptrdiff_t some_count = std::min(shapes_at_once, ssize(shapes_) - begin);
      offset_.assign(1, 0);
      for (std::ptrdiff_t i = 0; i < some_count; ++i) offset_.push_back(offset_.back() + derivative_size(some[i]));
      derivatives_.resize(offset_.back());
      for_each_at_once(some_count,
                       [&](std::ptrdiff_t i) { differentiate(energy, some[i], derivatives_.data() + offset_[i]); });
      for (std::ptrdiff_t i = 0; i < some_count; ++i) {
        checkpoint(operations_a_derivative * static_cast<double>(derivative_size(some[i])));
        add_derivatives(some[i], derivatives_.data() + offset_[i], gradient, add);
      }
    }
  };
  Eigen::VectorXd step;
  try {
    const Eigen::SparseMatrix<double>& hessian = hessian_.build(add_up);
    if (factor_)
      factor_->refactor(hessian);
    else
      factor_.emplace(hessian);
    step = factor_->solve(Eigen::VectorXd(-gradient));
  } catch (const Error& error) {
    if (error.code() != Code::solver_failed) throw;
    return std::nullopt;
  }
  Eigen::VectorXcd out(count);
  for (Index i = 0; i < count; ++i) {
    const auto [row, rows] = rows_of(i);
    out[i] = {step[row], rows == 2 ? step[row + 1] : 0};
  }
  return out;
}

bool NewtonMinimizer::search(const DistortionEnergy& energy, const Eigen::VectorXcd& direction, double longest,
                             double before, double& after) {
  const Eigen::VectorXcd start = position_(moving_);
  Eigen::VectorXcd displaced = Eigen::VectorXcd::Zero(start.size());
  for (Eigen::Index i = 0; i < displaced.size(); ++i) {
    displacement_.for_each_term(moving_[i],
                                [&](const Term& term) { displaced[i] += term.coefficient * direction[term.unknown]; });
  }
  for (double length = longest; length > 1e-8; length /= 2) {
    position_(moving_) = start + length * displaced;
    after = total(energy);
    if (after < before) return true;
  }
  position_(moving_) = start;
  after = before;
  return false;
}

double NewtonMinimizer::collapse_step(const Eigen::VectorXcd& direction) const {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto time = [&](const Shape& shape) {
    const Jacobian at = jacobian(shape), moved = change(shape, direction);
    const double a = std::norm(moved.f_z) - std::norm(moved.f_zbar);
    const double b = 2 * (std::real(std::conj(at.f_z) * moved.f_z) - std::real(std::conj(at.f_zbar) * moved.f_zbar));
    const double c = std::norm(at.f_z) - std::norm(at.f_zbar), discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return never;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    double first = never;
    for (const double root : {q / a, c / q}) {
      if (root > 0) first = std::min(first, root);
    }
    return first;
  };
  const Array<double> times = of_shapes(time);
  return std::accumulate(times.begin(), times.end(), never, [](double a, double b) { return std::min(a, b); });
}

}  // namespace lsgp
