// SPDX-License-Identifier: GPL-3.0-or-later
// The forms of a map under transitions, condensed onto the cuts: transitions involve only the copies that a CutFactor
// retains, so eliminating all others leaves a dense form over the unknowns of the retained copies (static condensation,
// Guyan 1965).
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "systems/cut_factor.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

class SchurComplement {
 public:
  // cut_mesh: along cuts that the factor covers.
  SchurComplement(Borrowed<const HalfedgeMesh> mesh, const CutMesh& cut_mesh, Borrowed<const CutFactor> factor,
                  const Reduction& reduction);

  // The condensed unknowns, numbered anew; the number of an unknown of the reduction, none if it is eliminated.
  Index unknown_count() const { return unknown_count_; }
  Index number_of(Index unknown) const { return number_of_[unknown]; }

  // The forms over them, (unknowns, unknowns), lower triangles; see energies/quadratic_forms.hpp.
  Eigen::MatrixXcd dirichlet_form() const;
  Eigen::MatrixXcd conformal_form(Eigen::MatrixXcd dirichlet_form) const;

  // A solve with the Dirichlet form in two halves.  pull: (the factor's copies). The first half returns the right-hand
  // side for the condensed unknowns, (unknowns); the second takes their values and returns the positions, (copies) of
  // the cut mesh.
  CutFactor::Rows eliminate(const Eigen::VectorXcd& pull) const;
  Eigen::VectorXcd right_side(const CutFactor::Rows& half_solved) const;
  Eigen::VectorXcd substitute(CutFactor::Rows half_solved, const Eigen::VectorXcd& unknowns) const;

  // The positions, (copies), of least Dirichlet energy for given values of those unknowns.
  Eigen::VectorXcd extend(const Eigen::VectorXcd& unknowns) const;

 private:
  template <typename Visit>
  void for_each_term(Visit visit) const {
    for (Index i = 0; i < factor_.retained_count(); ++i) {
      for (Index k = begin_[i]; k < begin_[i + 1]; ++k) visit(i, terms_[k]);
    }
  }

  const HalfedgeMesh& mesh_;
  const CutFactor& factor_;
  const Index copy_count_;
  PerCopy<Index> own_copy_;  // the factor's copies as those of the cut mesh, with fewer cuts
  Array<Index> number_of_;   // (unknowns of the reduction)
  Array<Index> begin_;       // (retained + 1)
  Array<Term> terms_;        // of retained copies, in condensed unknowns
  Index unknown_count_ = 0;
};

}  // namespace lsgp
