// SPDX-License-Identifier: GPL-3.0-or-later
// Dirichlet and conformal energy of a map of the cut mesh, as Hermitian forms in complex positions z = u + iv.
#pragma once

#include <Eigen/SparseCore>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "mesh/geometry.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

enum class Form {
  dirichlet,  // z^H L z = int |grad u|^2 + |grad v|^2, L the cotangent Laplacian
  conformal,  // that less twice the signed area: z^H C z = 4 int |f_zbar|^2 (LSCM energy); 0 for a conformal map
};

// The form's matrix over the unknowns, B^H L B or B^H C B; lower triangle.
Eigen::SparseMatrix<Complex> assemble_form(Form form, const MetricMesh& surface, const CutMesh& cut_mesh,
                                           const Reduction& reduction);

// The geometry whose Dirichlet form is weighted by triangle, (m).
Geometry with_weights(const Geometry& geometry, const Eigen::VectorXd& weight);

// The cotangent Laplacian of the surface itself, positive semidefinite, without the rows and columns of `held`
// vertices; lower triangle.  row_of_vertex: row numbers, none at held vertices.
struct Laplacian {
  Eigen::SparseMatrix<double> lower;
  PerVertex<Index> row_of_vertex;
};
Laplacian assemble_laplacian(const MetricMesh& surface, const PerVertex<char>& held);

// The Dirichlet form of the copies by themselves, each in the row given; lower triangle.
Eigen::SparseMatrix<double> assemble_dirichlet(const MetricMesh& surface, const CutMesh& cut_mesh,
                                               const PerCopy<Index>& row_of_copy);

// L y at every vertex, (n).
Eigen::VectorXd apply_laplacian(const MetricMesh& surface, const Eigen::VectorXd& values);

}  // namespace lsgp
