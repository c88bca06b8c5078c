// SPDX-License-Identifier: GPL-3.0-or-later
// Lattice points near a given point, by a quadratic form and under the condition that some triangles keep their area.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/array.hpp"
#include "plane/point_lattice.hpp"

namespace lsgp {

// A basis of the same lattice of d-tuples whose vectors are short and nearly orthogonal in the form (Lenstra, Lenstra
// and Lovasz 1982, over the Gaussian or Eisenstein integers).  form: (d, d) Hermitian positive definite.
// Returns the new basis vectors as columns over the old ones.
Eigen::MatrixXcd reduce_basis(const Eigen::MatrixXcd& form, const PointLattice& lattice);

// A triangle whose corners are slope * x, x the lattice points looked for.
struct MovingTriangle {
  std::array<Eigen::RowVectorXcd, 3> slope;  // (d)
};

// Searches tuples x of lattice points with small (x - wanted)^H form (x - wanted) for which every triangle has a
// doubled area of at least a lattice cell.
class LatticeSearch {
 public:
  LatticeSearch(Eigen::MatrixXcd form, Array<MovingTriangle> triangles, const PointLattice& lattice);

  struct Choice {
    Eigen::VectorXcd x;
    double cost = 0;       // of the quadratic form
    double violation = 0;  // the doubled areas that are missing, in cells
    bool valid() const { return violation < 1e-6; }
  };

  // The nearest plane's point (Babai 1986).
  Choice nearest(const Eigen::VectorXcd& wanted) const;

  // Moves a choice by single steps along short vectors, with growing penalties for missing area, until none is missing
  // and no step lowers the cost.
  Choice improve(const Eigen::VectorXcd& wanted, Choice choice) const;

 private:
  struct Move {
    Eigen::VectorXcd x;                     // (d)
    Eigen::VectorXcd pull;                  // form * x
    double cost;                            // x^H form x
    Array<std::array<Complex, 3>> corners;  // of the triangles it moves
    Array<int> triangles;                   // which those are
  };

  Array<std::array<Complex, 3>> corners_at(const Eigen::VectorXcd& x) const;
  void descend(const Eigen::VectorXcd& wanted, double penalty, Choice& choice) const;
  double violation(const std::array<Complex, 3>& corners) const;

  Eigen::MatrixXcd form_;
  Array<MovingTriangle> triangles_;
  PointLattice lattice_;
  Eigen::MatrixXcd reduced_;     // columns: the reduced basis
  Eigen::MatrixXcd triangular_;  // R of form = ..., over the reduced basis
  Array<Move> moves_;
};

}  // namespace lsgp
