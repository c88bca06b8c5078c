// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson_system.hpp"

#include "cut_factor.hpp"
#include "energies/quadratic_forms.hpp"
#include "solvers/dense_cholesky.hpp"

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
        factor_(assemble_form(Form::dirichlet, surface.mesh, surface.geometry, surface.cut_mesh, reduction)) {}

  Eigen::VectorXcd fit(const Jacobians& jacobians) const override {
    return expand(reduction_, factor_.solve(gather(reduction_, pull_of(surface_, jacobians))));
  }

 private:
  const CutSurface surface_;
  const Reduction& reduction_;
  Cholesky<Complex> factor_;
};

// Transitions touch the retained copies alone: the unknowns behind them are those of a dense problem.
class PoissonSystem::OnCut final : public Solver {
 public:
  OnCut(const CutSurface& surface, const Reduction& reduction)
      : surface_(surface), factor_(*surface.factor), copy_count_(surface.cut_mesh.copy_count()) {
    match_copies();
    std::vector<Index> place(reduction.unknown_count, none);
    begin_.push_back(0);
    for (const Index copy : factor_.retained()) {
      reduction.for_each_term(own_copy_[copy], [&](const Term& term) {
        if (place[term.unknown] == none) place[term.unknown] = unknown_count_++;
        terms_.push_back({place[term.unknown], term.coefficient});
      });
      begin_.push_back(static_cast<Index>(terms_.size()));
    }
    dense_.emplace(reduced_schur());
  }

  Eigen::VectorXcd fit(const Jacobians& jacobians) const override {
    const CutSurface opened{surface_.mesh, surface_.geometry, factor_.cut_graph(), factor_.cut_mesh()};
    const Eigen::VectorXcd pull = pull_of(opened, jacobians);
    const Index copies = factor_.cut_mesh().copy_count(), first = factor_.eliminated_count();
    CutFactor::Rows x(copies, 2);
    for (Index copy = 0; copy < copies; ++copy) {
      x(factor_.row_of_copy(copy), 0) = pull[copy].real();
      x(factor_.row_of_copy(copy), 1) = pull[copy].imag();
    }
    factor_.eliminate(x);
    Eigen::MatrixXcd unknowns = Eigen::VectorXcd::Zero(unknown_count_);
    for_each_term([&](Index i, const Term& term) {
      unknowns(term.unknown) += std::conj(term.coefficient) * Complex(x(first + i, 0), x(first + i, 1));
    });
    dense_->solve_in_place(unknowns);
    Eigen::VectorXcd retained = Eigen::VectorXcd::Zero(factor_.retained_count());
    for_each_term([&](Index i, const Term& term) { retained[i] += term.coefficient * unknowns(term.unknown); });
    x.bottomRows(retained.size()) << retained.real(), retained.imag();
    factor_.substitute(x, 2);
    Eigen::VectorXcd position(copy_count_);
    for (Index copy = 0; copy < copies; ++copy) {
      const Index row = factor_.row_of_copy(copy);
      position[own_copy_[copy]] = {x(row, 0), x(row, 1)};
    }
    return position;
  }

 private:
  // The factor's copies as copies of this surface, which may be opened along fewer cuts.
  void match_copies() {
    own_copy_.resize(factor_.cut_mesh().copy_count());
    for (Index corner = 0; corner < surface_.mesh.halfedge_count(); ++corner) {
      own_copy_[factor_.cut_mesh().copy_of_corner[corner]] = surface_.cut_mesh.copy_of_corner[corner];
    }
  }

  template <typename Visit>
  void for_each_term(Visit visit) const {
    for (Index i = 0; i < factor_.retained_count(); ++i) {
      for (Index k = begin_[i]; k < begin_[i + 1]; ++k) visit(i, terms_[k]);
    }
  }

  // B^H S B, S the Schur complement; lower triangle.
  Eigen::MatrixXcd reduced_schur() const {
    struct Use {
      Index copy;
      Complex coefficient;
    };
    std::vector<std::vector<Use>> uses(unknown_count_);
    for_each_term([&](Index i, const Term& term) { uses[term.unknown].push_back({i, term.coefficient}); });
    Eigen::MatrixXcd out = Eigen::MatrixXcd::Zero(unknown_count_, unknown_count_);
    Eigen::VectorXd real(factor_.retained_count()), imaginary(factor_.retained_count());
    for (Index unknown = 0; unknown < unknown_count_; ++unknown) {
      real.setZero();
      imaginary.setZero();
      for (const Use& use : uses[unknown]) {
        real += use.coefficient.real() * factor_.schur().col(use.copy);
        if (use.coefficient.imag() != 0) imaginary += use.coefficient.imag() * factor_.schur().col(use.copy);
      }
      for_each_term([&](Index i, const Term& term) {
        if (term.unknown >= unknown)
          out(term.unknown, unknown) += std::conj(term.coefficient) * Complex(real[i], imaginary[i]);
      });
    }
    return out;
  }

  const CutSurface surface_;
  const CutFactor& factor_;
  const Index copy_count_;
  std::vector<Index> own_copy_;  // (the factor's copies)
  std::vector<Index> begin_;     // (retained + 1)
  std::vector<Term> terms_;      // of retained copies, unknowns numbered anew
  Index unknown_count_ = 0;
  std::optional<DenseCholesky<Complex>> dense_;
};

PoissonSystem::PoissonSystem(const CutSurface& surface, const Reduction& reduction) {
  if (surface.factor != nullptr && surface.factor->covers(surface.cut_graph))
    solver_ = std::make_unique<OnCut>(surface, reduction);
  else
    solver_ = std::make_unique<Sparse>(surface, reduction);
}

PoissonSystem::~PoissonSystem() = default;

Eigen::VectorXcd PoissonSystem::fit(const Jacobians& jacobians) const { return solver_->fit(jacobians); }

}  // namespace lsgp
