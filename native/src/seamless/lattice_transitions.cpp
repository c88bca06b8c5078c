// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/lattice_transitions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lsgp/errors.hpp"
#include "transitions/transition_elimination.hpp"

namespace lsgp {

namespace {

// Restricts lattice points x to those for which condition * x is on the lattice, where its coefficients are quotients
// of lattice points by 1 - e^{i curvature}: modulo the lattice they are multiples of one of them.
void restrict_to_integral(const Eigen::RowVectorXcd& condition, const PointLattice& lattice, Eigen::MatrixXcd& basis) {
  constexpr double rounding = 1e-6;
  const auto integral = [&](Complex z) { return std::abs(z - lattice.nearest(z)) < rounding; };
  Eigen::Index pivot = -1;
  for (Eigen::Index k = 0; k < condition.size(); ++k) {
    if (!integral(condition[k])) pivot = k;
  }
  if (pivot < 0) return;
  Array<Complex> small{0.0};  // multipliers to try
  for (int turns = 0; turns < lattice.rotation_order(); ++turns) small.push_back(lattice.unit(turns));
  for (const Complex unit : {Complex(-1), lattice.generator(), -lattice.generator()}) small.push_back(unit);
  Eigen::MatrixXcd step = Eigen::MatrixXcd::Identity(condition.size(), condition.size());
  bool found = true;
  for (Eigen::Index k = 0; k < condition.size() && found; ++k) {
    if (k == pivot) continue;
    found = false;
    for (const Complex multiplier : small) {
      if (!integral(condition[k] - multiplier * condition[pivot])) continue;
      step(pivot, k) = -multiplier;
      found = true;
      break;
    }
  }
  const Complex g = lattice.generator();
  Complex period = 0;
  for (const Complex tried : {Complex(2), 1.0 + g}) {
    if (integral(tried * condition[pivot])) period = tried;
  }
  if (!found || period == 0.0) {
    throw Error(Code::seamless_impossible,
                "With these cones no layout has all of them on the lattice. Mark one more cone, or choose another "
                "lattice.");
  }
  step(pivot, pivot) = period;
  basis *= step;
}

}  // namespace

LatticeReduction impose_on_lattice(const CutSurface& surface, const NodeGraph& nodes,
                                   const Eigen::VectorXd& node_curvature, const PerCut<int>& turns,
                                   const LatticeConstraint& constraint) {
  const auto& [lattice, parity, relaxed] = constraint;
  const PerCut<Complex> turn = units_of(lattice, turns);
  TransitionElimination elimination(surface, nodes, node_curvature, turn, {Eliminate::translations});
  Array<Index> ids;  // of the integers
  for (Eigen::Index node = 0; node < node_curvature.size(); ++node) {
    const Index v = nodes.vertex[node];
    const bool free = std::find(relaxed.begin(), relaxed.end(), v) != relaxed.end();
    if (v != none && node_curvature[node] != 0 && !elimination.is_solved(v) && !free) ids.push_back(v);
  }
  // A layout may be translated by lattice vectors: one cone is put at the origin.
  Index ground = ids.empty() ? none : ids.front();
  if (ground != none) ids.erase(ids.begin());
  bool shifts = ground != none;
  LatticeReduction out;
  out.origin = ground;
  out.cones = ids;
  const Index n = surface.mesh.vertex_count();
  for (Index id = n; id < elimination.id_count(); ++id) {
    if (elimination.is_solved(id)) continue;
    ids.push_back(id);
    out.cuts.push_back(id - n);
    shifts = shifts || turn[id - n] != 1.0;
  }
  if (!shifts) ground = elimination.find_ground();
  const Array<Index> unknown = elimination.number(ground, out.reduction);
  elimination.express_all_copies(unknown, out.reduction);
  const Eigen::Index count = static_cast<Eigen::Index>(ids.size());
  Array<Index> column(elimination.id_count(), none);
  for (Eigen::Index k = 0; k < count; ++k) {
    out.integers.push_back(unknown[ids[k]]);
    column[ids[k]] = static_cast<Index>(k);
  }
  const auto add_row = [&](Index id, auto row) {
    for (const auto& [other, coefficient] : elimination.resolve(id)) {
      if (column[other] != none) row[column[other]] += coefficient;
    }
  };
  out.translation = Eigen::MatrixXcd::Zero(static_cast<Eigen::Index>(turn.size()), count);
  for (Index p = 0; p < ssize(turn); ++p) add_row(elimination.translation_id(p), out.translation.row(p));
  out.basis = Eigen::MatrixXcd::Identity(count, count);
  const auto cuts = static_cast<Eigen::Index>(out.cuts.size());
  // Eigen cannot take the diagonal of an empty matrix.
  if (parity && cuts > 0) out.basis.diagonal().tail(cuts).setConstant(Complex(1, 1));
  const Index first = nodes.order.empty() ? none : nodes.vertex[nodes.order.front()];
  if (first != none && elimination.is_solved(first)) {
    out.root = first;
    out.root_position = Eigen::RowVectorXcd::Zero(count);
    add_row(first, out.root_position.row(0));
    if (relaxed.empty()) restrict_to_integral(out.root_position * out.basis, lattice, out.basis);
  }
  return out;
}

PerCut<Complex> units_of(const PointLattice& lattice, const PerCut<int>& turns) {
  PerCut<Complex> out;
  for (const int t : turns) out.push_back(lattice.unit(t));
  return out;
}

Reduction reduce_locally(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                         const PerCut<Complex>& turn, Index origin) {
  TransitionElimination elimination(surface, nodes, node_curvature, turn, {Eliminate::positions, origin});
  Reduction out;
  elimination.express_all_copies(elimination.number(origin, out), out);
  return out;
}

}  // namespace lsgp
