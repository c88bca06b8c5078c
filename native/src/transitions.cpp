// SPDX-License-Identifier: GPL-3.0-or-later
#include "transitions.hpp"

#include <cmath>
#include <map>

namespace lsgp {

namespace {

// A sum of unknowns while they are still vertices and cuts; ordered, so that results do not depend on addresses.
using Expression = std::map<Index, Complex>;

void add_scaled(Expression& sum, Complex factor, const Expression& terms) {
  for (const auto& [id, coefficient] : terms) sum[id] += factor * coefficient;
}

// Where going round a node turns by at least this much (|1 - e^{i curvature}|), the node's own position is solved for:
// a local expression in the translations of its cuts.  Below it that would divide by almost nothing, and the
// translation towards the root, whose coefficient has modulus 1, is solved for instead.
constexpr double clear_turn = 0.01;

class Elimination {
 public:
  Elimination(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh, const NodeGraph& nodes,
              const Eigen::VectorXd& rotation)
      : mesh_(mesh),
        cut_graph_(cut_graph),
        cut_mesh_(cut_mesh),
        nodes_(nodes),
        n_(mesh.vertex_count()),
        solved_(n_ + cut_graph.cuts.size()),
        is_solved_(solved_.size(), 0),
        turn_(rotation.size()) {
    for (Eigen::Index p = 0; p < rotation.size(); ++p) turn_[p] = std::polar(1.0, rotation[p]);
  }

  Reduction reduce(const Eigen::VectorXd& node_curvature) {
    for (std::size_t i = nodes_.order.size(); i-- > 0;) {
      const Index node = nodes_.order[i];
      if (nodes_.vertex[node] != none) close_node(node, node_curvature[node]);
    }
    return number_unknowns();
  }

 private:
  Index translation_id(Index cut) const { return n_ + cut; }

  // What the crossing of an outgoing cut halfedge, counter-clockwise, does to an expression.
  Expression cross(const Expression& before, Index h) const {
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

  // The copies of a vertex in terms of its first one and the translations of the cuts at it.
  std::vector<std::pair<Index, Expression>> express_copies(Index v) const {
    std::vector<std::pair<Index, Expression>> out;
    for (const Sector& sector : sectors(mesh_, cut_graph_, cut_mesh_, v)) {
      out.emplace_back(sector.copy, out.empty() ? Expression{{v, 1.0}} : cross(out.back().second, sector.opened_by));
    }
    return out;
  }

  // Going once round: z_v = turned z_v + translations.
  void close_node(Index node, double curvature) {
    const Index v = nodes_.vertex[node];
    const auto all = sectors(mesh_, cut_graph_, cut_mesh_, v);
    Expression round = cross(express_copies(v).back().second, all.front().opened_by);
    const Complex gap = curvature == 0 ? 0.0 : 1.0 - round[v];
    round.erase(v);
    if (std::abs(gap) >= clear_turn) {
      for (auto& [id, coefficient] : round) coefficient /= gap;
      solve_for(v, std::move(round));
      return;
    }
    if (gap != 0.0) round[v] = -gap;
    Index pivot = nodes_.parent_cut[node] == none ? none : translation_id(nodes_.parent_cut[node]);
    if (pivot == none) {  // the root: its translations are functions of others by now
      Expression resolved;
      for (const auto& [id, coefficient] : round) add_scaled(resolved, coefficient, resolve(id));
      round = std::move(resolved);
      for (const auto& [id, coefficient] : round) {
        if (pivot == none || std::abs(coefficient) > std::abs(round[pivot])) pivot = id;
      }
      if (pivot == none || std::abs(round[pivot]) < clear_turn) return;  // closes by itself, as on a flat torus
    }
    const Complex scale = -1.0 / round[pivot];
    round.erase(pivot);
    for (auto& [id, coefficient] : round) coefficient *= scale;
    solve_for(pivot, std::move(round));
  }

  void solve_for(Index id, Expression expression) {
    solved_[id] = std::move(expression);
    is_solved_[id] = 1;
  }

  // In terms of unknowns that are not solved for.
  Expression resolve(Index id) const {
    if (!is_solved_[id]) return {{id, 1.0}};
    Expression out;
    for (const auto& [other, coefficient] : solved_[id]) add_scaled(out, coefficient, resolve(other));
    return out;
  }

  // The unknown that holds the layout in place: any whose value changes when the layout is shifted.
  Index find_ground() const {
    const auto shift = [&](Index id) { return id < n_ ? 1.0 : std::abs(1.0 - turn_[id - n_]); };
    Index ground = none;
    for (Index id = 0; id < static_cast<Index>(solved_.size()); ++id) {
      if (!is_solved_[id] && (ground == none || shift(id) > shift(ground))) ground = id;
    }
    return ground;
  }

  Reduction number_unknowns() {
    Reduction reduction;
    const Index ground = find_ground();
    std::vector<Index> unknown(solved_.size(), none);
    for (std::size_t id = 0; id < solved_.size(); ++id) {
      if (!is_solved_[id] && static_cast<Index>(id) != ground) unknown[id] = reduction.unknown_count++;
      // One pass makes later look-ups short: expressions stop at unsolved ones.
      if (is_solved_[id]) solved_[id] = resolve(static_cast<Index>(id));
    }
    std::vector<Expression> of_copy(cut_mesh_.copy_count());
    const std::vector<char> on_cut = on_cuts(mesh_, cut_graph_);
    for (Index v = 0; v < n_; ++v) {
      if (!on_cut[v]) continue;
      for (auto& [copy, expression] : express_copies(v)) {
        for (const auto& [id, coefficient] : expression) add_scaled(of_copy[copy], coefficient, resolve(id));
      }
    }
    reduction.begin.assign(1, 0);
    for (Index copy = 0; copy < cut_mesh_.copy_count(); ++copy) {
      const auto push = [&](Index id, Complex coefficient) {
        if (unknown[id] != none) reduction.terms.push_back({unknown[id], coefficient});
      };
      if (!on_cut[cut_mesh_.source[copy]]) push(copy, 1.0);
      for (const auto& [id, coefficient] : of_copy[copy]) push(id, coefficient);
      reduction.begin.push_back(static_cast<Index>(reduction.terms.size()));
    }
    return reduction;
  }

  const HalfedgeMesh& mesh_;
  const CutGraph& cut_graph_;
  const CutMesh& cut_mesh_;
  const NodeGraph& nodes_;
  const Index n_;
  std::vector<Expression> solved_;  // by id: vertices, then cuts
  std::vector<char> is_solved_;
  std::vector<Complex> turn_;  // (cuts) e^{i rotation}
};

}  // namespace

Reduction impose_transitions(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh,
                             const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                             const Eigen::VectorXd& rotation) {
  return Elimination(mesh, cut_graph, cut_mesh, nodes, rotation).reduce(node_curvature);
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
  for (std::size_t p = 0; p < cut_graph.cuts.size(); ++p) {
    const Complex turn = std::polar(1.0, rotation[p]);
    const std::vector<Index>& halfedges = cut_graph.cuts[p].halfedges;
    for (std::size_t i = 1; i < halfedges.size(); ++i) {
      const Sisters sisters = origin_sisters(mesh, cut_mesh, halfedges[i]);
      if (sisters.right >= mesh.vertex_count())
        motion[sisters.right] = turn;
      else
        motion[sisters.left] = std::conj(turn);
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
