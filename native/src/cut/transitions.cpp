// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/transitions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace lsgp {

namespace {

// A linear combination of vertices and cuts, before unknowns are numbered; ordered, so that results do not depend on
// addresses.
using Expression = std::map<Index, Complex>;

void add_scaled(Expression& sum, Complex factor, const Expression& terms) {
  for (const auto& [id, coefficient] : terms) sum[id] += factor * coefficient;
}

// If a loop around a node rotates by at least this much (|1 - e^{i curvature}|), the node's own position is eliminated:
// a local expression in the translations of its cuts. Below it this would divide by almost zero, and the translation
// towards the root, whose coefficient has modulus 1, is eliminated instead.
constexpr double clear_turn = 0.01;

enum class Eliminate {
  positions,     // of nodes with clear rotation: local expressions, small coefficients
  translations,  // towards the root, with unit coefficients: the remaining unknowns are independent lattice points
};

class Elimination {
 public:
  Elimination(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
              PerCut<Complex> turn, Eliminate eliminate)
      : mesh_(surface.mesh),
        cut_graph_(surface.cut_graph),
        cut_mesh_(surface.cut_mesh),
        nodes_(nodes),
        n_(mesh_.vertex_count()),
        is_solved_(n_ + ssize(cut_graph_.cuts), 0),
        turn_(std::move(turn)),
        eliminate_(eliminate) {
    for (std::size_t i = nodes_.order.size(); i-- > 0;) {
      const Index node = nodes_.order[i];
      if (nodes_.vertex[node] != none) close_node(node, node_curvature[node]);
    }
  }

  Reduction reduce() {
    Reduction reduction;
    express_all_copies(number(find_ground(), reduction), reduction);
    return reduction;
  }

  LatticeReduction reduce_to_lattice(const Eigen::VectorXd& node_curvature, const LatticeConstraint& constraint) {
    const auto& [lattice, parity, relaxed] = constraint;
    Array<Index> ids;  // of the integers
    for (Eigen::Index node = 0; node < node_curvature.size(); ++node) {
      const Index v = nodes_.vertex[node];
      const bool free = std::find(relaxed.begin(), relaxed.end(), v) != relaxed.end();
      if (v != none && node_curvature[node] != 0 && !is_solved_[v] && !free) ids.push_back(v);
    }
    // A layout may be translated by lattice vectors: one cone is put at the origin.
    Index ground = ids.empty() ? none : ids.front();
    if (ground != none) ids.erase(ids.begin());
    bool shifts = ground != none;
    LatticeReduction out;
    out.origin = ground;
    out.cones = ids;
    for (Index id = n_; id < id_count(); ++id) {
      if (is_solved_[id]) continue;
      ids.push_back(id);
      out.cuts.push_back(id - n_);
      shifts = shifts || turn_[id - n_] != 1.0;
    }
    if (!shifts) ground = find_ground();
    const Array<Index> unknown = number(ground, out.reduction);
    express_all_copies(unknown, out.reduction);
    const Eigen::Index count = static_cast<Eigen::Index>(ids.size());
    Array<Index> column(id_count(), none);
    for (Eigen::Index k = 0; k < count; ++k) {
      out.integers.push_back(unknown[ids[k]]);
      column[ids[k]] = static_cast<Index>(k);
    }
    const auto add_row = [&](Index id, auto row) {
      for (const auto& [other, coefficient] : resolve(id)) {
        if (column[other] != none) row[column[other]] += coefficient;
      }
    };
    out.translation = Eigen::MatrixXcd::Zero(static_cast<Eigen::Index>(turn_.size()), count);
    for (Index p = 0; p < ssize(turn_); ++p) add_row(translation_id(p), out.translation.row(p));
    out.basis = Eigen::MatrixXcd::Identity(count, count);
    const auto cuts = static_cast<Eigen::Index>(out.cuts.size());
    // Eigen cannot take the diagonal of an empty matrix.
    if (parity && cuts > 0) out.basis.diagonal().tail(cuts).setConstant(Complex(1, 1));
    const Index first = nodes_.order.empty() ? none : nodes_.vertex[nodes_.order.front()];
    if (first != none && is_solved_[first]) {
      out.root = first;
      out.root_position = Eigen::RowVectorXcd::Zero(count);
      add_row(first, out.root_position.row(0));
      if (relaxed.empty()) restrict_to_integral(out.root_position * out.basis, lattice, out.basis);
    }
    return out;
  }

 private:
  Index id_count() const { return static_cast<Index>(is_solved_.size()); }
  Index translation_id(Index cut) const { return n_ + cut; }

  // Applies the transition across an outgoing cut halfedge, counter-clockwise, to an expression.
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
  Array<std::pair<Index, Expression>> express_copies(Index v) const {
    Array<std::pair<Index, Expression>> out;
    for (const Sector& sector : sectors(mesh_, cut_graph_, cut_mesh_, v)) {
      out.emplace_back(sector.copy, out.empty() ? Expression{{v, 1.0}} : cross(out.back().second, sector.opened_by));
    }
    return out;
  }

  // A loop around the node: z_v = rotated z_v + translations.
  void close_node(Index node, double curvature) {
    const Index v = nodes_.vertex[node];
    const auto all = sectors(mesh_, cut_graph_, cut_mesh_, v);
    Expression round = cross(express_copies(v).back().second, all.front().opened_by);
    const Complex gap = curvature == 0 ? 0.0 : 1.0 - round[v];
    round.erase(v);
    const bool solves_position = eliminate_ == Eliminate::positions || nodes_.parent_cut[node] == none;
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
        if (std::abs(coefficient) < clear_turn) continue;
        const bool larger = pivot == none || std::abs(coefficient) > std::abs(round[pivot]);
        // On a lattice the smallest coefficient is the one that may divide the others.
        if (pivot == none || larger == (eliminate_ == Eliminate::positions)) pivot = id;
      }
      if (pivot == none) return;  // closes by itself, as on a flat torus
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
    for (const auto& [other, coefficient] : solved_.at(id)) add_scaled(out, coefficient, resolve(other));
    return out;
  }

  // The unknown that fixes the layout's position: any that changes when the layout is translated, except vertices off
  // cuts and boundaries, which are to be eliminated first.
  Index find_ground() const {
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

  // Numbers the remaining unknowns except the fixed one, (ids).
  Array<Index> number(Index ground, Reduction& reduction) {
    Array<Index> unknown(id_count(), none);
    for (Index id = 0; id < id_count(); ++id) {
      if (!is_solved_[id] && id != ground) unknown[id] = reduction.unknown_count++;
    }
    // One pass makes later look-ups short: expressions stop at unsolved ones.
    for (auto& [id, expression] : solved_) expression = resolve(id);
    return unknown;
  }

  void express_all_copies(const Array<Index>& unknown, Reduction& reduction) const {
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

  // Restricts lattice points x to those for which condition * x is on the lattice, where its coefficients are quotients
  // of lattice points by 1 - e^{i curvature}: modulo the lattice they are multiples of one of them.
  void restrict_to_integral(const Eigen::RowVectorXcd& condition, const PointLattice& lattice,
                            Eigen::MatrixXcd& basis) const {
    constexpr double rounding = 1e-6;
    const auto integral = [&](Complex z) { return std::abs(z - lattice.nearest(z)) < rounding; };
    Eigen::Index pivot = -1;
    for (Eigen::Index k = 0; k < condition.size(); ++k) {
      if (!integral(condition[k])) pivot = k;
    }
    if (pivot < 0) return;
    Array<Complex> small{0.0};  // multipliers to try
    for (int turns = 0; turns < lattice.symmetry(); ++turns) small.push_back(lattice.unit(turns));
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

  const HalfedgeMesh& mesh_;
  const CutGraph& cut_graph_;
  const CutMesh& cut_mesh_;
  const NodeGraph& nodes_;
  const Index n_;
  std::map<Index, Expression> solved_;  // by id: vertices, then cuts
  Array<char> is_solved_;               // (ids)
  PerCut<Complex> turn_;                // e^{i rotation}
  const Eliminate eliminate_;
};

}  // namespace

Reduction impose_transitions(const CutSurface& surface, const NodeGraph& nodes, const Eigen::VectorXd& node_curvature,
                             const Eigen::VectorXd& rotation) {
  PerCut<Complex> turn(rotation.size());
  for (Eigen::Index p = 0; p < rotation.size(); ++p) turn[p] = std::polar(1.0, rotation[p]);
  return Elimination(surface, nodes, node_curvature, std::move(turn), Eliminate::positions).reduce();
}

LatticeReduction impose_on_lattice(const CutSurface& surface, const NodeGraph& nodes,
                                   const Eigen::VectorXd& node_curvature, const PerCut<int>& turns,
                                   const LatticeConstraint& constraint) {
  PerCut<Complex> turn;
  for (const int t : turns) turn.push_back(constraint.lattice.unit(t));
  return Elimination(surface, nodes, node_curvature, std::move(turn), Eliminate::translations)
      .reduce_to_lattice(node_curvature, constraint);
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
