// SPDX-License-Identifier: GPL-3.0-or-later
#include "transitions/transition_elimination.hpp"

#include <cmath>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

using Expression = TransitionElimination::Expression;

constexpr double operations_a_term = 50;  // in an ordered map

void add_scaled(Expression& sum, Complex factor, const Expression& terms) {
  checkpoint(operations_a_term * static_cast<double>(terms.size()));
  for (const auto& [id, coefficient] : terms) sum[id] += factor * coefficient;
}

// If a loop around a node rotates by at least this much (|1 - e^{i curvature}|), the node's own position is eliminated:
// a local expression in the translations of its cuts. Below it this would divide by almost zero, and the translation
// toward the root, whose coefficient has modulus 1, is eliminated instead.
constexpr double clear_turn = 0.01;
constexpr double least_coefficient = 1e-9;  // others are rounding errors

}  // namespace

TransitionElimination::TransitionElimination(const CutSurface& surface, const NodeGraph& nodes,
                                             const Eigen::VectorXd& node_curvature, PerCut<Complex> turn,
                                             EliminationRule rule)
    : mesh_(surface.mesh),
      cut_graph_(surface.cut_graph),
      cut_mesh_(surface.cut_mesh),
      nodes_(nodes),
      n_(mesh_.vertex_count()),
      is_solved_(n_ + ssize(cut_graph_.cuts), 0),
      turn_(std::move(turn)),
      rule_(rule) {
  for (std::size_t i = nodes_.order.size(); i-- > 0;) {
    const Index node = nodes_.order[i];
    if (nodes_.vertex[node] != none) close_node(node, node_curvature[node]);
  }
}

TransitionElimination::Expression TransitionElimination::resolve(Index id) const {
  if (!is_solved_[id]) return {{id, 1.0}};
  Expression out;
  for (const auto& [other, coefficient] : solved_.at(id)) add_scaled(out, coefficient, resolve(other));
  return out;
}

Index TransitionElimination::find_ground() const {
  const PerVertex<char> on_cut = on_cuts(mesh_, cut_graph_);
  const auto shift = [&](Index id) {
    if (id >= n_) return std::abs(1.0 - turn_[id - n_]);
    return on_cut[id] || mesh_.loop_of_vertex[id] != none ? 1.0 : 0.0;
  };
  Index ground = none;
  for (Index id = 0; id < id_count(); ++id) {
    if (!is_solved_[id] && (ground == none || shift(id) > shift(ground))) ground = id;
  }
  return ground;
}

Array<Index> TransitionElimination::number(Index ground, Reduction& reduction) {
  Array<Index> unknown(id_count(), none);
  for (Index id = 0; id < id_count(); ++id) {
    if (!is_solved_[id] && id != ground) unknown[id] = reduction.unknown_count++;
  }
  // One pass makes later look-ups short: expressions stop at unsolved ones.
  for (auto& [id, expression] : solved_) expression = resolve(id);
  return unknown;
}

void TransitionElimination::express_all_copies(const Array<Index>& unknown, Reduction& reduction) const {
  std::map<Index, Expression> of_copy;  // those on cuts
  const PerVertex<char> on_cut = on_cuts(mesh_, cut_graph_);
  for (Index v = 0; v < n_; ++v) {
    if (!on_cut[v]) continue;
    for (auto& [copy, expression] : express_copies(v)) {
      Expression& resolved = of_copy[copy];
      for (const auto& [id, coefficient] : expression) add_scaled(resolved, coefficient, resolve(id));
    }
  }
  const Index copy_count = cut_mesh_.copy_count();
  reduction.begin.reserve(copy_count + 1);
  reduction.terms.reserve(copy_count + 4 * ssize(of_copy));
  reduction.begin.push_back(0);
  for (Index copy = 0; copy < copy_count; ++copy) {
    const auto push = [&](Index id, Complex coefficient) {
      if (unknown[id] != none) reduction.terms.push_back({unknown[id], coefficient});
    };
    if (on_cut[cut_mesh_.source[copy]]) {
      for (const auto& [id, coefficient] : of_copy[copy]) push(id, coefficient);
    } else {
      push(copy, 1.0);
    }
    reduction.begin.push_back(static_cast<Index>(reduction.terms.size()));
  }
}

TransitionElimination::Expression TransitionElimination::cross(const Expression& before, Index h) const {
  const Index cut = cut_graph_.cut_of[h];
  Expression after;
  if (cut_graph_.runs_forward[h]) {  // from the right copy to the left one
    add_scaled(after, std::conj(turn_[cut]), before);
    after[translation_id(cut)] -= std::conj(turn_[cut]);
  } else {  // seen from its head, the cut's left side comes first
    add_scaled(after, turn_[cut], before);
    after[translation_id(cut)] += 1.0;
  }
  return after;
}

Array<std::pair<Index, Expression>> TransitionElimination::express_copies(Index v) const {
  Array<std::pair<Index, Expression>> out;
  for (const Sector& sector : sectors(mesh_, cut_graph_, cut_mesh_, v)) {
    out.emplace_back(sector.copy, out.empty() ? Expression{{v, 1.0}} : cross(out.back().second, sector.opened_by));
  }
  return out;
}

void TransitionElimination::close_node(Index node, double curvature) {
  const Index v = nodes_.vertex[node];
  const auto all = sectors(mesh_, cut_graph_, cut_mesh_, v);
  Expression round = cross(express_copies(v).back().second, all.front().opened_by);
  const Complex gap = curvature == 0 ? 0.0 : 1.0 - round[v];
  round.erase(v);
  const bool is_local = rule_.eliminate == Eliminate::positions && v != rule_.kept;
  const bool solves_position = is_local || nodes_.parent_cut[node] == none;
  if (std::abs(gap) >= clear_turn && solves_position) {
    for (auto& [id, coefficient] : round) coefficient /= gap;
    solve_for(v, std::move(round));
    return;
  }
  if (gap != 0.0) round[v] = -gap;
  Index pivot = nodes_.parent_cut[node] == none ? none : translation_id(nodes_.parent_cut[node]);
  if (pivot == none) {  // the root: its translations are already expressed by others
    Expression resolved;
    for (const auto& [id, coefficient] : round) add_scaled(resolved, coefficient, resolve(id));
    round = std::move(resolved);
    for (const auto& [id, coefficient] : round) {
      if (std::abs(coefficient) < least_coefficient) continue;
      const bool larger = pivot == none || std::abs(coefficient) > std::abs(round[pivot]);
      // On a lattice the smallest coefficient is the one that may divide the others.
      if (pivot == none || larger == (rule_.eliminate == Eliminate::positions)) pivot = id;
    }
    if (pivot == none) return;  // closes by itself, as on a flat torus
  }
  const Complex scale = -1.0 / round[pivot];
  round.erase(pivot);
  for (auto& [id, coefficient] : round) coefficient *= scale;
  solve_for(pivot, std::move(round));
}

void TransitionElimination::solve_for(Index id, Expression expression) {
  solved_[id] = std::move(expression);
  is_solved_[id] = 1;
}

}  // namespace lsgp
