// SPDX-License-Identifier: GPL-3.0-or-later
// Transitions whose cones and translations lie on a lattice (the paper's section 8).
#pragma once

#include <Eigen/Core>

#include "plane/point_lattice.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// As of impose_transitions, with the positions of cones as unknowns, as far as they can be: those and the translations
// that are left over may each take any value of the lattice, and all other cones and translations then lie on it too.
struct LatticeReduction {
  Reduction reduction;
  Index origin = none;                // the cone that is held at 0, if any
  Array<Index> integers;              // (d) unknowns that take values on the lattice:
  Array<Index> cones;                 // the positions of these vertices, and after them
  Array<Index> cuts;                  // the translations of these cuts
  Eigen::MatrixXcd translation;       // (cuts, d) all translations as functions of the integers
  Index root = none;                  // the cone whose position follows from the integers, if any
  Eigen::RowVectorXcd root_position;  // (d) as a function of them
  Eigen::MatrixXcd basis;             // (d, d) the integers are basis * any lattice points
};

// What is to lie on a lattice.
struct LatticeConstraint {
  const PointLattice& lattice;
  bool parity;                  // translations lead from white cells to white ones
  const Array<Index>& relaxed;  // cones that may be anywhere; then the root and what lies between leave the lattice too
};

// turns: rotations in multiples of 2 pi / q.  nodes: rooted at a boundary loop, or at a cone whose 1 - e^{i
// curvature} is as small as can be but not 0.  Throws SEAMLESS_IMPOSSIBLE.
LatticeReduction impose_on_lattice(const CutSurface& surface, const NodeGraph& nodes,
                                   const Eigen::VectorXd& node_curvature, const PerCut<int>& turns,
                                   const LatticeConstraint& constraint);

// (cuts) The units of the lattice by which cuts turn.
PerCut<Complex> units_of(const PointLattice& lattice, const PerCut<int>& turns);

// The same maps as functions of unknowns nearby, where integers far away have an effect on most copies: positions of
// cones follow from the translations of their cuts.  turn: units of the lattice.  origin: of its reduction, not the
// root.
Reduction reduce_locally(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                         const PerCut<Complex>& turn, Index origin);

}  // namespace lsgp
