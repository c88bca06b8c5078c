// SPDX-License-Identifier: GPL-3.0-or-later
// Affine transitions across the cuts, exact by elimination (the paper's section 4.2, equation (1)).
//
// Every copy's position is a linear function of a few unknowns: one position per vertex and one translation per cut,
// less one unknown per inside node, since going once round a node has to come back to where it began.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "transitions/holonomy.hpp"

namespace lsgp {

struct Term {
  Index unknown;
  Complex coefficient;
};

// The positions of all copies as functions of the unknowns: z_copy = sum of coefficient * unknown.
// Translations of the whole layout are left out: one unknown is held at zero.
struct Reduction {
  Array<Index> begin;  // (copies + 1)
  Array<Term> terms;   // of copy i: begin[i] to begin[i + 1]
  Index unknown_count = 0;

  Index copy_count() const { return static_cast<Index>(begin.size()) - 1; }
  template <typename Visit>
  void for_each_term(Index copy, Visit visit) const {
    for (Index i = begin[copy]; i < begin[copy + 1]; ++i) visit(terms[i]);
  }
};

// rotation: (cuts) radians, as from find_rotations; node_curvature as there.
Reduction impose_transitions(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                             const Eigen::VectorXd& rotation);

// Every copy an unknown of its own but `grounded`, which is held at zero: no transitions.
Reduction leave_free(const CutMesh& cut_mesh, Index grounded);

// How every copy of a vertex moves when its first copy moves by 1 and all translations stay: a factor of modulus 1.
// Holds for vertices that are no cone; a cone's position follows from its translations.
Eigen::VectorXcd motion_of_copies(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh,
                                  const Eigen::VectorXd& rotation);

// Positions of all copies (copies) from the unknowns.
Eigen::VectorXcd expand(const Reduction& reduction, const Eigen::VectorXcd& unknowns);

// Gathers what acts on the copies onto the unknowns: the adjoint of expand.
Eigen::VectorXcd gather(const Reduction& reduction, const Eigen::VectorXcd& on_copies);

}  // namespace lsgp
