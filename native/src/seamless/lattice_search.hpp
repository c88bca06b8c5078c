// SPDX-License-Identifier: GPL-3.0-or-later
// Lattice points near a given point, by a quadratic form and under the condition that some triangles keep their area.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <utility>

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
  LatticeSearch(Eigen::MatrixXcd form, const Array<MovingTriangle>& triangles, const PointLattice& lattice);

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
    Array<std::pair<Eigen::Index, Complex>> x;  // the coordinates that are not 0
    Eigen::VectorXcd pull;                      // form * x
    double cost;                                // x^H form x
    Array<std::array<Complex, 3>> corners;      // of the triangles it moves
    Array<int> triangles;                       // which those are
  };

  // The part of x in a corner of a triangle.
  struct Part {
    int triangle;
    std::size_t corner;
    Complex slope;
  };

  void add_move(const Eigen::VectorXcd& x, const Eigen::VectorXcd& pull);
  Array<std::array<Complex, 3>> corners_at(const Eigen::VectorXcd& x) const;
  using Changes = std::array<double, 6>;  // by each of the units, of which there are up to 6
  struct Descent;
  void descend(const Eigen::VectorXcd& wanted, double penalty, Choice& choice) const;
  double violation(const std::array<Complex, 3>& corners) const;

  Eigen::MatrixXcd form_;
  Array<Array<Part>> parts_;  // of each coordinate, by triangles: few, since cones move the triangles around them
  PointLattice lattice_;
  Array<Complex> units_;      // the shortest vectors of the lattice
  Eigen::MatrixXcd reduced_;  // columns: the reduced basis
  Eigen::PartialPivLU<Eigen::MatrixXcd> inverse_of_reduced_;
  Eigen::MatrixXcd triangular_;  // R of form = ..., over the reduced basis
  Array<Move> moves_;
  Array<Array<std::pair<int, int>>> moves_of_triangle_;  // and which of their triangles it is
};

}  // namespace lsgp
