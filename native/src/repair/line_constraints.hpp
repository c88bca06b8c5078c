// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of a layout with prescribed directions, eliminated exactly: the remaining degrees of freedom.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <utility>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "repair/newton.hpp"
#include "systems/poisson_system.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// A coordinate: the imaginary part of the sum of factor * position over some copies.
using CoordinateForm = Array<std::pair<Index, Complex>>;
double value_of(const CoordinateForm& form, const Eigen::VectorXcd& position);

// Halfedges and their directions in the layout, unit vectors.
struct DirectedEdges {
  Array<Index> halfedges;
  Array<Complex> directions;
  Array<Index> held{};            // copies that stay at 0
  Array<CoordinateForm> fixed{};  // coordinates that stay at 0
};

// Positions and translations under the condition that the edges keep their directions. Redundant equations are left
// out; contradictory ones leave edges without length.
DegreesOfFreedom free_along(const CutSurface& surface, const Reduction& reduction, const DirectedEdges& edges);

// Positions as linear functions of degrees of freedom in real numbers, and their Dirichlet form.
class FreedomSystem {
 public:
  FreedomSystem(const CutSurface& surface, const DegreesOfFreedom& freedom);

  // (2 copies, rows) row 2 c is u of copy c, row 2 c + 1 its v; rows as of first_rows.
  const Eigen::SparseMatrix<double>& coordinates() const { return coordinates_; }
  // (rows, rows) all of it.
  const Eigen::SparseMatrix<double>& dirichlet() const { return dirichlet_; }

  // The least squares fit to Jacobians among positions that are sums of the degrees of freedom. Throws SOLVER_FAILED.
  Eigen::VectorXcd fit(const Jacobians& jacobians) const;
  // The positions, (copies), from (rows) numbers.
  Eigen::VectorXcd expand(const Eigen::VectorXd& values) const;
  // The coefficients of coordinates, (rows, forms).
  Eigen::SparseMatrix<double> coefficients_of(const Array<CoordinateForm>& forms) const;

 private:
  const CutSurface& surface_;
  Eigen::SparseMatrix<double> coordinates_, dirichlet_;
};

}  // namespace lsgp
