// SPDX-License-Identifier: GPL-3.0-or-later
#include "transitions/transitions.hpp"

#include <cmath>

#include "transitions/transition_elimination.hpp"

namespace lsgp {

Reduction impose_transitions(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                             const Eigen::VectorXd& rotation) {
  PerCut<Complex> turn(rotation.size());
  for (Eigen::Index p = 0; p < rotation.size(); ++p) turn[p] = std::polar(1.0, rotation[p]);
  TransitionElimination elimination(surface, nodes, node_curvature, std::move(turn), {Eliminate::positions});
  Reduction reduction;
  elimination.express_all_copies(elimination.number(elimination.find_ground(), reduction), reduction);
  return reduction;
}

Reduction leave_free(const CutMesh& cut_mesh, Index grounded) {
  Reduction reduction;
  reduction.begin.assign(1, 0);
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    if (copy != grounded) reduction.terms.push_back({reduction.unknown_count++, 1.0});
    reduction.begin.push_back(static_cast<Index>(reduction.terms.size()));
  }
  return reduction;
}

Eigen::VectorXcd motion_of_copies(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh,
                                  const Eigen::VectorXd& rotation) {
  Eigen::VectorXcd motion = Eigen::VectorXcd::Ones(cut_mesh.copy_count());
  const PerVertex<char> on_cut = on_cuts(mesh, cut_graph);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!on_cut[v]) continue;
    Complex turn = 1;
    for (const Sector& sector : sectors(mesh, cut_graph, cut_mesh, v)) {
      if (sector.copy != v) {
        const double crossed = rotation[cut_graph.cut_of[sector.opened_by]];
        turn *= std::polar(1.0, cut_graph.runs_forward[sector.opened_by] ? -crossed : crossed);
      }
      motion[sector.copy] = turn;
    }
  }
  return motion;
}

Eigen::VectorXcd expand(const Reduction& reduction, const Eigen::VectorXcd& unknowns) {
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(reduction.copy_count());
  for (Index copy = 0; copy < reduction.copy_count(); ++copy) {
    reduction.for_each_term(copy, [&](const Term& term) { out[copy] += term.coefficient * unknowns[term.unknown]; });
  }
  return out;
}

Eigen::VectorXcd gather(const Reduction& reduction, const Eigen::VectorXcd& on_copies) {
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(reduction.unknown_count);
  for (Index copy = 0; copy < reduction.copy_count(); ++copy) {
    reduction.for_each_term(
        copy, [&](const Term& term) { out[term.unknown] += std::conj(term.coefficient) * on_copies[copy]; });
  }
  return out;
}

}  // namespace lsgp
