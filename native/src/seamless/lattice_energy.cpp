// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/lattice_energy.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "solvers/cholesky.hpp"
#include "solvers/dense_cholesky.hpp"
#include "solvers/sparse_assembly.hpp"
#include "systems/quadratic_forms.hpp"
#include "systems/schur_complement.hpp"

namespace lsgp {

namespace {

Eigen::MatrixXcd hermitian_part(const Eigen::MatrixXcd& matrix) { return (matrix + matrix.adjoint()) / 2; }

class SparseLatticeEnergy final : public LatticeEnergy {
 public:
  SparseLatticeEnergy(const CutSurface& surface, const LatticeReduction& lattice) : lattice_(lattice) {
    const auto form = assemble_form(Form::dirichlet, surface, surface.cut_mesh, lattice.reduction);
    const Index unknowns = lattice.reduction.unknown_count, count = static_cast<Index>(lattice.integers.size());
    Array<Index> column_of_unknown(unknowns, none);
    for (Index k = 0; k < count; ++k) column_of_unknown[lattice.integers[k]] = k;
    row_of_unknown_.assign(unknowns, none);
    Index rows = 0;
    for (Index i = 0; i < unknowns; ++i) {
      if (column_of_unknown[i] == none) row_of_unknown_[i] = rows++;
    }
    LowerAssembly<Complex> free(rows, static_cast<std::size_t>(form.nonZeros()));
    std::vector<Eigen::Triplet<Complex>> coupling;
    Eigen::MatrixXcd schur = Eigen::MatrixXcd::Zero(count, count);
    for (int j = 0; j < form.outerSize(); ++j) {
      for (Eigen::SparseMatrix<Complex>::InnerIterator it(form, j); it; ++it) {
        const Index i = static_cast<Index>(it.row());
        const Index row_i = row_of_unknown_[i], row_j = row_of_unknown_[j];
        const Index column_i = column_of_unknown[i], column_j = column_of_unknown[j];
        if (row_i != none && row_j != none) {
          free.add(row_i, row_j, it.value());
        } else if (row_i != none) {
          coupling.emplace_back(row_i, column_j, it.value());
        } else if (row_j != none) {
          coupling.emplace_back(row_j, column_i, std::conj(it.value()));
        } else {
          schur(column_i, column_j) += it.value();
          if (i != j) schur(column_j, column_i) += std::conj(it.value());
        }
      }
    }
    factor_.emplace(free.build());
    coupling_.resize(rows, count);
    coupling_.setFromTriplets(coupling.begin(), coupling.end());
    constexpr Index block = 16;  // right sides at a time
    for (Index first = 0; first < count; first += block) {
      const Index width = std::min(block, count - first);
      const Eigen::MatrixXcd columns = coupling_.middleCols(first, width);
      schur.middleCols(first, width) -= coupling_.adjoint() * factor_->solve(columns);
    }
    schur_ = hermitian_part(schur);
  }

  Eigen::VectorXcd displacement(const Eigen::VectorXcd& change) const override {
    const Eigen::VectorXcd moved = factor_->solve(Eigen::VectorXcd(coupling_ * change));
    Eigen::VectorXcd unknowns(row_of_unknown_.size());
    for (std::size_t i = 0; i < row_of_unknown_.size(); ++i) {
      if (row_of_unknown_[i] != none) unknowns[static_cast<Eigen::Index>(i)] = -moved[row_of_unknown_[i]];
    }
    for (std::size_t k = 0; k < lattice_.integers.size(); ++k) {
      unknowns[lattice_.integers[k]] = change[static_cast<Eigen::Index>(k)];
    }
    return expand(lattice_.reduction, unknowns);
  }

 private:
  const LatticeReduction& lattice_;
  Array<Index> row_of_unknown_;
  std::optional<Cholesky<Complex>> factor_;  // of the Dirichlet form with the integers held
  Eigen::SparseMatrix<Complex> coupling_;    // (rows, d) of the form
};

// All integers are unknowns of copies on the cuts: positions of cones, or translations across cuts.
class LatticeEnergyOnCut final : public LatticeEnergy {
 public:
  LatticeEnergyOnCut(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const CutFactor& factor,
                     const LatticeReduction& lattice)
      : schur_complement_(mesh, cut_mesh, factor, lattice.reduction) {
    Array<char> is_integer(schur_complement_.unknown_count(), 0);
    for (const Index unknown : lattice.integers) {
      integers_.push_back(schur_complement_.number_of(unknown));
      is_integer[integers_.back()] = 1;
    }
    for (Index i = 0; i < schur_complement_.unknown_count(); ++i) {
      if (!is_integer[i]) free_.push_back(i);
    }
    const Eigen::MatrixXcd form(schur_complement_.dirichlet_form().selfadjointView<Eigen::Lower>());
    const Eigen::MatrixXcd coupling = form(free_, integers_);
    following_ = -DenseCholesky<Complex>(form(free_, free_)).solve(coupling);
    schur_ = hermitian_part(form(integers_, integers_) + coupling.adjoint() * following_);
  }

  Eigen::VectorXcd displacement(const Eigen::VectorXcd& change) const override {
    Eigen::VectorXcd unknowns(schur_complement_.unknown_count());
    unknowns(integers_) = change;
    unknowns(free_) = following_ * change;
    return schur_complement_.extend(unknowns);
  }

 private:
  const SchurComplement schur_complement_;
  Array<Index> integers_, free_;  // by their condensed numbers
  Eigen::MatrixXcd following_;    // (free, d) what the free unknowns do when the integers move
};

}  // namespace

std::unique_ptr<LatticeEnergy> sparse_lattice_energy(const CutSurface& surface,
                                                     Borrowed<const LatticeReduction> lattice) {
  return std::make_unique<SparseLatticeEnergy>(surface, lattice);
}

std::unique_ptr<LatticeEnergy> lattice_energy_on_cut(Borrowed<const HalfedgeMesh> mesh, const CutMesh& cut_mesh,
                                                     Borrowed<const CutFactor> factor,
                                                     const LatticeReduction& lattice) {
  return std::make_unique<LatticeEnergyOnCut>(mesh, cut_mesh, factor, lattice);
}

}  // namespace lsgp
