// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on distortion energies of a map, with all transitions fixed.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"
#include "solvers/cholesky.hpp"
#include "solvers/sparse_assembly.hpp"
#include "systems/distortion_energy.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// Degrees of freedom: displacements of all copies as functions of the unknowns, and the triangles that move.
struct DegreesOfFreedom {
  Reduction displacement;
  Array<Index> triangles;
  Array<char> is_real{};  // (unknowns) those with real values only; empty: none
};

// First row of every unknown in the real system, (unknowns + 1): two rows for a complex unknown, one for a real one.
Array<Index> first_rows(const DegreesOfFreedom& freedom);

// The marked vertices; translations are fixed.  motion: (copies) as from motion_of_copies.
DegreesOfFreedom free_vertices(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Eigen::VectorXcd& motion,
                               const PerVertex<char>& marked);

// All positions and translations except those that vertices marked as fixed depend on.
DegreesOfFreedom free_all(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Reduction& reduction,
                          const PerVertex<char>& fixed);

// The vertices within some rings of triangles, those of the triangles themselves being the first ring.
PerVertex<char> mark_around(const HalfedgeMesh& mesh, const Array<Index>& triangles, int rings);

// Called before every step of Newton's method; its exceptions propagate.
using StepHook = std::function<void()>;

// Rest shapes of triangles: those of the surface, scaled by e^{log_scale} and rotated by frames.
struct RestShapes {
  const Eigen::VectorXd& log_scale;  // (n)
  const Eigen::VectorXd& frames;     // (m) radians
};

// A map and its fixed vertices.
struct HeldMap {
  const Eigen::VectorXcd& position;  // (copies) u + iv
  const PerVertex<char>& fixed;      // vertices that do not move
};

class NewtonMinimizer {
 public:
  // Triangles are weighted by area.  position: (copies) u + iv, which is modified.
  NewtonMinimizer(const CutSurface& surface, const RestShapes& rest, DegreesOfFreedom freedom, StepHook before_step,
                  Eigen::VectorXcd& position);

  Index triangle_count() const { return static_cast<Index>(shapes_.size()); }

  // Multiplies the weights of triangles, (m).
  void weigh(const Eigen::VectorXd& factors);

  // Newton steps on a foldover-free energy (Garanzha et al. 2021) until every moving triangle is upright, and with the
  // framed one within 90 degrees of its frame. Returns whether that was reached.
  bool unfold(DistortionEnergy::Kind kind, int most_steps);

  // Newton steps on a barrier from a map without flips, which stays free of flips. At most `steps`, fewer if the
  // relative decrease of the energy is small or a step cannot be computed.
  void smooth(DistortionEnergy::Kind barrier, int steps, double least_share = 0);

 private:
  struct Shape {
    Complex g[3], h[3];
    Index triangle, copy[3];
    Index begin, end;  // of its slopes
    double weight;
  };

  // The derivatives of a triangle's f_z and f_zbar by one unknown.
  struct Slope {
    Index unknown;
    Complex f_z, f_zbar;
  };

  void add_slope(Index begin, const Slope& slope);

  struct Jacobian {
    Complex f_z, f_zbar;
  };
  // of(shape) of every shape, in their order.
  template <typename Of>
  Array<double> of_shapes(Of of) const;
  Jacobian jacobian(const Shape& shape) const;
  Jacobian change(const Shape& shape, const Eigen::VectorXcd& direction) const;
  double smallest_determinant(const DistortionEnergy& energy) const;

  double total(const DistortionEnergy& energy) const;
  // What a triangle adds to the gradient, 2 numbers for each of its unknowns, and then to the Hessian, 2 x 2 numbers
  // for each of its unknowns and every one up to it.
  static std::ptrdiff_t derivative_size(const Shape& shape);
  void differentiate(const DistortionEnergy& energy, const Shape& shape, double* out) const;
  template <typename Add>
  void add_derivatives(const Shape& shape, const double* derivatives, Eigen::VectorXd& gradient, const Add& add) const;
  // None if the Hessian cannot be factored.
  std::optional<Eigen::VectorXcd> newton_direction(const DistortionEnergy& energy);

  // Halves the step until the energy falls; leaves the positions unchanged if it never does.
  bool search(const DistortionEnergy& energy, const Eigen::VectorXcd& direction, double longest, double before,
              double& after);

  // The step along a direction at which the first triangle degenerates.
  double collapse_step(const Eigen::VectorXcd& direction) const;

  // The first row of an unknown in the Hessian, and their number.
  std::pair<Index, int> rows_of(Index unknown) const {
    return {first_row_[unknown], first_row_[unknown + 1] - first_row_[unknown]};
  }

  const Array<Index> first_row_;  // (unknowns + 1) of the Hessian
  const Reduction displacement_;
  Array<Index> moving_;  // the copies that are displaced, few in local repairs
  const StepHook before_step_;
  Eigen::VectorXcd& position_;
  Array<Shape> shapes_;
  Array<Slope> slopes_;
  Array<double> derivatives_;  // of some triangles, whose memory serves every step
  Array<std::ptrdiff_t> offset_;
  RepeatedAssembly<double> hessian_;
  std::optional<Cholesky<double>> factor_;
};

}  // namespace lsgp
