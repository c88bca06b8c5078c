// SPDX-License-Identifier: GPL-3.0-or-later
// The elimination by which transitions hold exactly (the paper's section 4.2): once round a node leads back to the
// start.
#pragma once

#include <map>
#include <utility>

#include "transitions/transitions.hpp"

namespace lsgp {

enum class Eliminate {
  positions,     // of nodes with clear rotation: local expressions, small coefficients
  translations,  // toward the root, with unit coefficients: the remaining unknowns are independent lattice points
};

struct EliminationRule {
  Eliminate eliminate;
  Index kept = none;  // a vertex whose position is not eliminated, not the root
};

// Unknowns have ids: the vertices' positions, and after them the cuts' translations.
class TransitionElimination {
 public:
  // A linear combination of vertices and cuts, before unknowns are numbered; ordered, so that results do not depend on
  // addresses.
  using Expression = std::map<Index, Complex>;

  // node_curvature: as of find_rotations.  turn: e^{i rotation}.
  TransitionElimination(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                        PerCut<Complex> turn, EliminationRule rule);

  Index id_count() const { return static_cast<Index>(is_solved_.size()); }
  Index translation_id(Index cut) const { return n_ + cut; }
  bool is_solved(Index id) const { return is_solved_[id] != 0; }

  // In terms of unknowns that are not solved for.
  Expression resolve(Index id) const;
  // The unknown that fixes the layout's position: any that changes when the layout is translated, except vertices off
  // cuts and boundaries, which are to be eliminated first.
  Index find_ground() const;
  // Numbers the remaining unknowns except the fixed one, (ids).
  Array<Index> number(Index ground, Reduction& reduction);
  // unknown: as numbered.
  void express_all_copies(const Array<Index>& unknown, Reduction& reduction) const;

 private:
  // Applies the transition across an outgoing cut halfedge, counter-clockwise, to an expression.
  Expression cross(const Expression& before, Index h) const;
  // The copies of a vertex in terms of its first one and the translations of the cuts at it.
  Array<std::pair<Index, Expression>> express_copies(Index v) const;
  // A loop around the node: z_v = rotated z_v + translations.
  void close_node(Index node, double curvature);
  void solve_for(Index id, Expression expression);

  const HalfedgeMesh& mesh_;
  const CutGraph& cut_graph_;
  const CutMesh& cut_mesh_;
  const NodeGraph& nodes_;
  const Index n_;
  std::map<Index, Expression> solved_;  // by id
  Array<char> is_solved_;               // (ids)
  const PerCut<Complex> turn_;
  const EliminationRule rule_;
};

}  // namespace lsgp
