// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/lscm.hpp"

#include "base/array.hpp"
#include "solvers/cholesky.hpp"
#include "solvers/eigenproblem.hpp"
#include "systems/quadratic_forms.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

namespace {

// The copies along the open boundary that contains the lowest-numbered boundary copy.
Array<Index> open_border(const HalfedgeMesh& mesh, const CutMesh& cut_mesh) {
  PerCopy<Index> next_copy(cut_mesh.copy_count(), none);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_open(mesh, cut_mesh, h)) next_copy[cut_mesh.copy_of_corner[h]] = cut_mesh.copy_of_corner[next(h)];
  }
  Array<Index> border;
  for (Index copy = 0; copy < cut_mesh.copy_count() && border.empty(); ++copy) {
    if (next_copy[copy] == none) continue;
    for (Index at = copy; border.empty() || at != copy; at = next_copy[at]) border.push_back(at);
  }
  return border;
}

}  // namespace

Eigen::VectorXcd unfold_lscm(const MetricMesh& surface, const CutMesh& cut_mesh) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Array<Index> border = open_border(mesh, cut_mesh);
  const Index first = border.front(), second = border[border.size() / 2];
  const Reduction reduction = leave_free(cut_mesh, first);
  const auto conformal = assemble_form(Form::conformal, surface, cut_mesh, reduction);
  const auto dirichlet = assemble_form(Form::dirichlet, surface, cut_mesh, reduction);
  // With one pin at the origin, a load at the other gives the map with both pinned, up to scale and rotation.
  Eigen::VectorXcd pull = Eigen::VectorXcd::Zero(reduction.unknown_count);
  pull[reduction.terms[reduction.begin[second]].unknown] = 1;
  return expand(reduction, factor_regularized(conformal, dirichlet).solve(pull));
}

}  // namespace lsgp
