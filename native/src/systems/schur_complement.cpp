// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/schur_complement.hpp"

#include <algorithm>
#include <utility>

#include "base/memory.hpp"
#include "base/thread_team.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

namespace {

// Columns of a form that one thread fills.
constexpr Index columns_at_once = 32;
// Of its entries, which take as long as a triangle elsewhere.
constexpr std::ptrdiff_t entries_of_triangle = 16;

}  // namespace

SchurComplement::SchurComplement(Borrowed<const HalfedgeMesh> mesh, const CutMesh& cut_mesh,
                                 Borrowed<const CutFactor> factor, const Reduction& reduction)
    : mesh_(mesh),
      factor_(factor),
      copy_count_(cut_mesh.copy_count()),
      own_copy_(factor_.cut_mesh().copy_count()),
      number_of_(reduction.unknown_count, none),
      begin_{0} {
  for (Index corner = 0; corner < mesh_.halfedge_count(); ++corner) {
    own_copy_[factor_.cut_mesh().copy_of_corner[corner]] = cut_mesh.copy_of_corner[corner];
  }
  for (const Index copy : factor_.retained()) {
    reduction.for_each_term(own_copy_[copy], [&](const Term& term) {
      if (number_of_[term.unknown] == none) number_of_[term.unknown] = unknown_count_++;
      terms_.push_back({number_of_[term.unknown], term.coefficient});
    });
    begin_.push_back(static_cast<Index>(terms_.size()));
  }
}

// B^H S B, S the Schur complement, column by column.
Eigen::MatrixXcd SchurComplement::dirichlet_form() const {
  struct Use {
    Index copy;
    Complex coefficient;
  };
  Array<Array<Use>> uses(unknown_count_);
  for_each_term([&](Index i, const Term& term) { uses[term.unknown].push_back({i, term.coefficient}); });
  // This form and its factor.
  require_memory(2.0 * sizeof(Complex) * unknown_count_ * unknown_count_, GrowsWith::conditions);
  Eigen::MatrixXcd out = Eigen::MatrixXcd::Zero(unknown_count_, unknown_count_);
  const auto fill_columns = [&](Index begin, Index end) {
    Eigen::VectorXd real(factor_.retained_count()), imaginary(factor_.retained_count());
    for (Index unknown = begin; unknown < end; ++unknown) {
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
  };
  const std::ptrdiff_t entries = std::ptrdiff_t{unknown_count_} * factor_.retained_count();
  if (!is_worth_threads(entries / entries_of_triangle)) {
    fill_columns(0, unknown_count_);
    return out;
  }
  const Index blocks = (unknown_count_ + columns_at_once - 1) / columns_at_once;
  team_of_this_call().run_each(blocks, [&](Index block) {
    fill_columns(block * columns_at_once, std::min((block + 1) * columns_at_once, unknown_count_));
  });
  return out;
}

// Twice the signed area is the sum of Im(conj(z_from) z_to) over the open edges, whose copies are all retained.
Eigen::MatrixXcd SchurComplement::conformal_form(Eigen::MatrixXcd dirichlet_form) const {
  Eigen::MatrixXcd out = std::move(dirichlet_form);
  const CutMesh& opened = factor_.cut_mesh();
  PerCopy<Index> retained_of_copy(opened.copy_count(), none);
  for (Index i = 0; i < factor_.retained_count(); ++i) retained_of_copy[factor_.retained()[i]] = i;
  const auto add = [&](Index row, Index column, Complex value) {
    if (row >= column) out(row, column) += value;
  };
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (!is_open(mesh_, opened, h)) continue;
    const Index from = retained_of_copy[opened.copy_of_corner[h]];
    const Index to = retained_of_copy[opened.copy_of_corner[next(h)]];
    for (Index i = begin_[from]; i < begin_[from + 1]; ++i) {
      for (Index j = begin_[to]; j < begin_[to + 1]; ++j) {
        const Complex entry = std::conj(terms_[i].coefficient) * Complex(0, 0.5) * terms_[j].coefficient;
        add(terms_[i].unknown, terms_[j].unknown, entry);
        add(terms_[j].unknown, terms_[i].unknown, std::conj(entry));
      }
    }
  }
  return out;
}

CutFactor::Rows SchurComplement::eliminate(const Eigen::VectorXcd& pull) const {
  CutFactor::Rows rows(pull.size(), 2);
  for (Index copy = 0; copy < pull.size(); ++copy) {
    rows.row(factor_.row_of_copy(copy)) << pull[copy].real(), pull[copy].imag();
  }
  factor_.eliminate(rows);
  return rows;
}

Eigen::VectorXcd SchurComplement::right_side(const CutFactor::Rows& half_solved) const {
  const auto retained = half_solved.bottomRows(factor_.retained_count());
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(unknown_count_);
  for_each_term([&](Index i, const Term& term) {
    out[term.unknown] += std::conj(term.coefficient) * Complex(retained(i, 0), retained(i, 1));
  });
  return out;
}

Eigen::VectorXcd SchurComplement::substitute(CutFactor::Rows half_solved, const Eigen::VectorXcd& unknowns) const {
  Eigen::VectorXcd retained = Eigen::VectorXcd::Zero(factor_.retained_count());
  for_each_term([&](Index i, const Term& term) { retained[i] += term.coefficient * unknowns[term.unknown]; });
  half_solved.bottomRows(retained.size()) << retained.real(), retained.imag();
  count_back_substitutions(2);
  factor_.substitute(half_solved);
  Eigen::VectorXcd position(copy_count_);
  for (Index copy = 0; copy < static_cast<Index>(own_copy_.size()); ++copy) {
    const Index row = factor_.row_of_copy(copy);
    position[own_copy_[copy]] = {half_solved(row, 0), half_solved(row, 1)};
  }
  return position;
}

Eigen::VectorXcd SchurComplement::extend(const Eigen::VectorXcd& unknowns) const {
  return substitute(CutFactor::Rows::Zero(factor_.cut_mesh().copy_count(), 2), unknowns);
}

}  // namespace lsgp
