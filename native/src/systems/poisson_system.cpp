// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/poisson_system.hpp"

#include "solvers/dense_cholesky.hpp"
#include "systems/quadratic_forms.hpp"
#include "systems/schur_complement.hpp"

namespace lsgp {

// min sum A (|f_z - T|^2 + |f_zbar - S|^2) is z^H L z / 2 - 2 Re(...), and the right side at a corner is
// 2 A (conj(g) T + conj(h) S) with g = -i conj(e) / (4 A), h = i e / (4 A), e the edge opposite the corner.
Eigen::VectorXcd pull_of(const CutSurface& surface, const Jacobians& jacobians) {
  Eigen::VectorXcd pull = Eigen::VectorXcd::Zero(surface.cut_mesh.copy_count());
  for (Index f = 0; f < surface.mesh.triangle_count(); ++f) {
    for (Index corner = 3 * f; corner < 3 * f + 3; ++corner) {
      const Complex edge = edge_vector(surface.geometry, next(corner));
      pull[surface.cut_mesh.copy_of_corner[corner]] +=
          Complex(0, 0.5) * (edge * jacobians.f_z[f] - std::conj(edge) * jacobians.f_zbar[f]);
    }
  }
  return pull;
}

class PoissonSystem::Solver {
 public:
  virtual ~Solver() = default;
  virtual Eigen::VectorXcd fit(const Jacobians& jacobians) const = 0;
};

class PoissonSystem::Sparse final : public Solver {
 public:
  Sparse(const CutSurface& surface, const Reduction& reduction)
      : surface_(surface),
        reduction_(reduction),
        factor_(assemble_form(Form::dirichlet, surface, surface.cut_mesh, reduction)) {}

  Eigen::VectorXcd fit(const Jacobians& jacobians) const override {
    return expand(reduction_, factor_.solve(gather(reduction_, pull_of(surface_, jacobians))));
  }

 private:
  const CutSurface surface_;
  const Reduction& reduction_;
  Cholesky<Complex> factor_;
};

class PoissonSystem::OnCut final : public Solver {
 public:
  OnCut(const CutSurface& surface, const Reduction& reduction)
      : surface_(surface),
        schur_complement_(surface.mesh, surface.cut_mesh, *surface.factor, reduction),
        dense_(schur_complement_.dirichlet_form()) {}

  Eigen::VectorXcd fit(const Jacobians& jacobians) const override {
    const CutFactor& factor = *surface_.factor;
    const CutSurface opened{surface_, factor.cut_graph(), factor.cut_mesh()};
    CutFactor::Rows half_solved = schur_complement_.eliminate(pull_of(opened, jacobians));
    const Eigen::VectorXcd unknowns = dense_.solve(schur_complement_.right_side(half_solved));
    return schur_complement_.substitute(std::move(half_solved), unknowns);
  }

 private:
  const CutSurface surface_;
  const SchurComplement schur_complement_;
  const DenseCholesky<Complex> dense_;
};

PoissonSystem::PoissonSystem(const CutSurface& surface, const Reduction& reduction) {
  if (surface.factor != nullptr)
    solver_ = std::make_unique<OnCut>(surface, reduction);
  else
    solver_ = std::make_unique<Sparse>(surface, reduction);
}

PoissonSystem::~PoissonSystem() = default;

Eigen::VectorXcd PoissonSystem::fit(const Jacobians& jacobians) const { return solver_->fit(jacobians); }

}  // namespace lsgp
