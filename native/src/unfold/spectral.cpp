// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/spectral.hpp"

#include <cmath>
#include <complex>

#include "solvers/eigenproblem.hpp"
#include "systems/quadratic_forms.hpp"
#include "systems/schur_complement.hpp"

namespace lsgp {

namespace {

// An eigenvector multiplied by any complex number of modulus 1 is another, and rounding would choose among them: here
// the position farthest from the center is turned to the positive u axis, the first of those that are equally far but
// for rounding. The origin is a vertex among several that are equally good, which rounding chooses as well.
Eigen::VectorXcd with_fixed_rotation(const Eigen::VectorXcd& position) {
  constexpr double nearly = 1 - 1e-6;
  const Eigen::VectorXcd from_center = position.array() - position.mean();
  const double farthest = from_center.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  while (std::abs(from_center[first]) < nearly * farthest) ++first;
  return position * std::polar(1.0, -std::arg(from_center[first]));
}

}  // namespace

// Off the cuts both forms are the same, so that the eigenvectors are harmonic there.
Eigen::VectorXcd unfold_spectral(const CutSurface& surface, const Reduction& reduction) {
  if (surface.factor != nullptr) {
    const SchurComplement schur_complement(surface.mesh, surface.cut_mesh, *surface.factor, reduction);
    const Eigen::MatrixXcd dirichlet = schur_complement.dirichlet_form();
    return with_fixed_rotation(
        schur_complement.extend(smallest_eigenvector(schur_complement.conformal_form(dirichlet), dirichlet)));
  }
  const auto form = [&](Form kind) { return assemble_form(kind, surface, surface.cut_mesh, reduction); };
  return with_fixed_rotation(expand(reduction, smallest_eigenvector(form(Form::conformal), form(Form::dirichlet))));
}

}  // namespace lsgp
