// SPDX-License-Identifier: GPL-3.0-or-later
#include "untangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "distortion.hpp"
#include "energies/distortion_energy.hpp"
#include "solvers/cholesky.hpp"
#include "solvers/sparse_assembly.hpp"
#include "transitions.hpp"

namespace lsgp {

namespace {

constexpr std::array<int, 3> neighbourhoods{2, 5, 10};  // rings of vertices around flipped triangles
constexpr int most_newton_steps = 60;
constexpr int barrier_steps = 3;
constexpr double smallest_epsilon = 1e-3;
constexpr double ridge = 1e-9;         // of the mean diagonal
constexpr double barrier_share = 0.9;  // of the step at which the first triangle would collapse

// The vertices a repair may move, and the triangles that move with them.
struct Region {
  std::vector<Index> triangles;
  std::vector<Index> unknown_of_vertex;  // (n) none where fixed
  Index unknown_count = 0;
};

Region grow_region(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const std::vector<char>& fixed,
                   const std::vector<Index>& flipped, int rings) {
  std::vector<char> inside(mesh.vertex_count(), 0);
  std::vector<Index> front;
  const auto reach = [&](Index v, std::vector<Index>& reached) {
    if (inside[v]) return;
    inside[v] = 1;
    reached.push_back(v);
  };
  for (const Index f : flipped) {
    for (int c = 0; c < 3; ++c) reach(mesh.triangles(f, c), front);
  }
  for (int ring = 1; ring < rings; ++ring) {
    std::vector<Index> reached;
    for (const Index v : front) {
      mesh.for_each_outgoing(v, [&](Index h) {
        reach(mesh.target(h), reached);
        reach(mesh.origin(prev(h)), reached);
      });
    }
    front = std::move(reached);
  }
  for (const Cut& cut : cut_graph.cuts) inside[cut.tail] = inside[cut.head] = 0;

  Region region;
  region.unknown_of_vertex.assign(mesh.vertex_count(), none);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    inside[v] = inside[v] && !fixed[v];
    if (inside[v]) region.unknown_of_vertex[v] = region.unknown_count++;
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const bool moves = inside[mesh.triangles(f, 0)] || inside[mesh.triangles(f, 1)] || inside[mesh.triangles(f, 2)];
    if (moves) region.triangles.push_back(f);
  }
  return region;
}

class LocalRepair {
 public:
  LocalRepair(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
              const Eigen::VectorXcd& motion, const Eigen::VectorXd& log_scale, Region region,
              Eigen::VectorXcd& position)
      : cut_mesh_(cut_mesh), motion_(motion), region_(std::move(region)), position_(position) {
    shapes_.reserve(region_.triangles.size());
    for (const Index f : region_.triangles) {
      const double scale = std::exp(
          (log_scale[mesh.triangles(f, 0)] + log_scale[mesh.triangles(f, 1)] + log_scale[mesh.triangles(f, 2)]) / 3);
      Shape shape;
      shape.weight = geometry.area[f] * scale * scale;
      for (int c = 0; c < 3; ++c) {
        // f_z = sum g_j z_j and f_zbar = sum h_j z_j with g = -i conj(e) / (4 A), h = i e / (4 A), e opposite corner j.
        const Complex edge = edge_vector(geometry, next(3 * f + c)) / (4 * geometry.area[f] * scale);
        shape.g[c] = Complex(0, -1) * std::conj(edge);
        shape.h[c] = Complex(0, 1) * edge;
        const Index copy = cut_mesh.copy_of_corner[3 * f + c];
        shape.copy[c] = copy;
        shape.unknown[c] = region_.unknown_of_vertex[cut_mesh.source[copy]];
      }
      shapes_.push_back(shape);
    }
  }

  // Newton steps on the foldover-free energy until every triangle of the region is upright.
  bool unfold() {
    double lowest = smallest_determinant();
    double epsilon = std::max(smallest_epsilon, -lowest);
    for (int step = 0; step < most_newton_steps && !(lowest > 0); ++step) {
      const auto terms = [&](double d) { return foldover_free(d, epsilon); };
      const double before = energy(terms);
      const Eigen::VectorXcd direction = newton_direction(terms);
      double after = before;
      if (!search(terms, direction, 1, before, after)) return false;
      lowest = smallest_determinant();
      // Garanzha et al. 2021, equation (7): epsilon falls as fast as the energy does.
      const double decrease = std::max(0.1, 1 - after / before);
      const double mu = (1 - decrease) * foldover_chi(lowest, epsilon);
      if (lowest < mu) epsilon = std::max(2 * std::sqrt(mu * (mu - lowest)), std::numeric_limits<double>::min());
    }
    return lowest > 0;
  }

  // A few Newton steps towards conformality; no triangle collapses on the way.
  void smooth() {
    for (int step = 0; step < barrier_steps; ++step) {
      const double before = energy(conformal_barrier);
      const Eigen::VectorXcd direction = newton_direction(conformal_barrier);
      double after = before;
      if (!search(conformal_barrier, direction, std::min(1.0, barrier_share * collapse_step(direction)), before, after))
        return;
    }
  }

 private:
  struct Shape {
    Complex g[3], h[3];
    Index copy[3], unknown[3];
    double weight;
  };

  struct Jacobian {
    Complex f_z, f_zbar;
    double determinant() const { return std::norm(f_z) - std::norm(f_zbar); }
  };

  Jacobian jacobian(const Shape& shape) const {
    Jacobian out{0, 0};
    for (int c = 0; c < 3; ++c) {
      out.f_z += shape.g[c] * position_[shape.copy[c]];
      out.f_zbar += shape.h[c] * position_[shape.copy[c]];
    }
    return out;
  }

  Jacobian change(const Shape& shape, const Eigen::VectorXcd& direction) const {
    Jacobian out{0, 0};
    for (int c = 0; c < 3; ++c) {
      if (shape.unknown[c] == none) continue;
      const Complex moved = motion_[shape.copy[c]] * direction[shape.unknown[c]];
      out.f_z += shape.g[c] * moved;
      out.f_zbar += shape.h[c] * moved;
    }
    return out;
  }

  double smallest_determinant() const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Shape& shape : shapes_) lowest = std::min(lowest, jacobian(shape).determinant());
    return lowest;
  }

  template <typename Terms>
  double energy(const Terms& terms_at) const {
    double total = 0;
    for (const Shape& shape : shapes_) {
      const Jacobian at = jacobian(shape);
      const RadialTerms terms = terms_at(at.determinant());
      total += shape.weight * ((std::norm(at.f_z) + std::norm(at.f_zbar)) * terms.phi + terms.psi);
    }
    return total;
  }

  template <typename Terms>
  Eigen::VectorXcd newton_direction(const Terms& terms_at) const {
    const int size = 2 * region_.unknown_count;
    LowerAssembly<double> assembly(size, 25 * shapes_.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    double trace = 0;
    for (const Shape& shape : shapes_) {
      const Jacobian at = jacobian(shape);
      const EnergyExpansion expansion = expand_energy(at.f_z, at.f_zbar, terms_at(at.determinant()));
      // Real form of (f_z, f_zbar) as functions of the corners' unknowns.
      Eigen::Matrix<double, 4, 6> map = Eigen::Matrix<double, 4, 6>::Zero();
      for (int c = 0; c < 3; ++c) {
        if (shape.unknown[c] == none) continue;
        const Complex g = shape.g[c] * motion_[shape.copy[c]], h = shape.h[c] * motion_[shape.copy[c]];
        map.block<4, 2>(0, 2 * c) << g.real(), -g.imag(), g.imag(), g.real(), h.real(), -h.imag(), h.imag(), h.real();
      }
      const Eigen::Matrix<double, 6, 1> slope = shape.weight * map.transpose() * expansion.gradient;
      const Eigen::Matrix<double, 6, 6> bend = shape.weight * map.transpose() * expansion.hessian * map;
      for (int i = 0; i < 6; ++i) {
        if (shape.unknown[i / 2] == none) continue;
        const int row = 2 * shape.unknown[i / 2] + i % 2;
        gradient[row] += slope[i];
        trace += bend(i, i);
        for (int j = 0; j <= i; ++j) {
          if (shape.unknown[j / 2] != none) assembly.add(row, 2 * shape.unknown[j / 2] + j % 2, bend(i, j));
        }
      }
    }
    for (int i = 0; i < size; ++i) assembly.add(i, i, ridge * trace / size);
    const Eigen::VectorXd step = Cholesky<double>(assembly.build()).solve(Eigen::VectorXd(-gradient));
    Eigen::VectorXcd out(region_.unknown_count);
    for (Index i = 0; i < region_.unknown_count; ++i) out[i] = {step[2 * i], step[2 * i + 1]};
    return out;
  }

  void move(const Eigen::VectorXcd& direction, double length) {
    for (Index copy = 0; copy < cut_mesh_.copy_count(); ++copy) {
      const Index unknown = region_.unknown_of_vertex[cut_mesh_.source[copy]];
      if (unknown != none) position_[copy] += length * motion_[copy] * direction[unknown];
    }
  }

  // Halves the step until the energy falls; leaves the positions as they were where it never does.
  template <typename Terms>
  bool search(const Terms& terms, const Eigen::VectorXcd& direction, double longest, double before, double& after) {
    const Eigen::VectorXcd start = position_;
    for (double length = longest; length > 1e-8; length /= 2) {
      move(direction, length);
      after = energy(terms);
      if (after < before) return true;
      position_ = start;
    }
    after = before;
    return false;
  }

  // The step along a direction at which the first triangle has no area any more.
  double collapse_step(const Eigen::VectorXcd& direction) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const Shape& shape : shapes_) {
      const Jacobian at = jacobian(shape), moved = change(shape, direction);
      const double a = moved.determinant();
      const double b = 2 * (std::real(std::conj(at.f_z) * moved.f_z) - std::real(std::conj(at.f_zbar) * moved.f_zbar));
      const double c = at.determinant(), discriminant = b * b - 4 * a * c;
      if (discriminant < 0) continue;
      const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
      for (const double root : {q / a, c / q}) {
        if (root > 0) shortest = std::min(shortest, root);
      }
    }
    return shortest;
  }

  const CutMesh& cut_mesh_;
  const Eigen::VectorXcd& motion_;
  const Region region_;
  Eigen::VectorXcd& position_;
  std::vector<Shape> shapes_;
};

}  // namespace

Eigen::VectorXcd untangle(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                          const CutMesh& cut_mesh, const Eigen::VectorXd& rotation, const Curvature& curvature,
                          const std::vector<char>& fixed, const Eigen::VectorXcd& position) {
  const Eigen::VectorXcd motion = motion_of_copies(mesh, cut_graph, cut_mesh, rotation);
  const auto check = [&](const Eigen::VectorXcd& tried) {
    return check_map(mesh, at_corners(cut_mesh, tried), curvature.at_vertex, curvature.is_free);
  };
  const auto defects = [](const Validity& validity) {
    return validity.flipped.size() + validity.wrong_angle_sums.size();
  };
  const Validity initial = check(position);
  Eigen::VectorXcd best = position;
  std::size_t fewest = defects(initial);
  for (const int rings : neighbourhoods) {
    Region region = grow_region(mesh, cut_graph, fixed, initial.flipped, rings);
    if (region.unknown_count == 0) continue;
    Eigen::VectorXcd tried = position;
    LocalRepair repair(mesh, geometry, cut_mesh, motion, curvature.log_scale, std::move(region), tried);
    if (repair.unfold()) repair.smooth();
    const std::size_t left = defects(check(tried));
    if (left < fewest) {
      fewest = left;
      best = std::move(tried);
    }
    if (fewest == 0) break;
  }
  return best;
}

}  // namespace lsgp
