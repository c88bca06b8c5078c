// SPDX-License-Identifier: GPL-3.0-or-later
#include "laplace_solver.hpp"

#include <algorithm>
#include <optional>

#include "energies/quadratic_forms.hpp"
#include "solvers/dense_cholesky.hpp"

namespace lsgp {

Eigen::MatrixXd LaplaceSolver::solve_impulses(const std::vector<Index>& vertices) const {
  Eigen::MatrixXd impulses = Eigen::MatrixXd::Zero(vertex_count_, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) impulses(vertices[i], static_cast<Eigen::Index>(i)) = 1;
  return solve(impulses);
}

namespace {

class SparseLaplace final : public LaplaceSolver {
 public:
  explicit SparseLaplace(const Laplacian& laplacian)
      : LaplaceSolver(static_cast<Index>(laplacian.row_of_vertex.size())),
        row_of_vertex_(laplacian.row_of_vertex),
        factor_(laplacian.lower) {}

  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const override {
    Eigen::MatrixXd x(factor_.size(), right_sides.cols());
    for (std::size_t v = 0; v < row_of_vertex_.size(); ++v) {
      if (row_of_vertex_[v] != none) x.row(row_of_vertex_[v]) = right_sides.row(v);
    }
    factor_.eliminate(x);
    factor_.substitute(x);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(right_sides.rows(), right_sides.cols());
    for (std::size_t v = 0; v < row_of_vertex_.size(); ++v) {
      if (row_of_vertex_[v] != none) out.row(v) = x.row(row_of_vertex_[v]);
    }
    return out;
  }

 private:
  std::vector<Index> row_of_vertex_;
  Cholesky<double> factor_;
};

class LaplaceOnCut final : public LaplaceSolver {
 public:
  LaplaceOnCut(const CutFactor& factor, Index vertex_count, const std::vector<char>& held)
      : LaplaceSolver(vertex_count), factor_(factor), glued_(vertex_count, none), first_copy_(vertex_count, none) {
    const CutMesh& cut_mesh = factor.cut_mesh();
    for (Index copy = cut_mesh.copy_count(); copy-- > 0;) first_copy_[cut_mesh.source[copy]] = copy;
    for (const Index copy : factor.retained()) {
      const Index v = cut_mesh.source[copy];
      if (!held[v] && glued_[v] == none) glued_[v] = glued_count_++;
    }
    // With nothing held, the last one is, which fixes the constant.
    if (std::none_of(held.begin(), held.end(), [](char h) { return h; })) {
      *std::find(glued_.begin(), glued_.end(), --glued_count_) = none;
    }
    dense_.emplace(glue());
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const override {
    // A right side acts on one copy of each vertex: they are one.
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(factor_.cut_mesh().copy_count(), right_sides.cols());
    for (Eigen::Index v = 0; v < right_sides.rows(); ++v)
      x.row(factor_.row_of_copy(first_copy_[v])) = right_sides.row(v);
    factor_.eliminate(x);
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(glued_count_, right_sides.cols());
    for (const Index copy : factor_.retained()) {
      const Index at = glued_[factor_.cut_mesh().source[copy]];
      if (at != none) pull.row(at) += x.row(factor_.row_of_copy(copy));
    }
    return finish(pull, x);
  }

  Eigen::MatrixXd solve_impulses(const std::vector<Index>& vertices) const override {
    const bool all_retained = std::all_of(vertices.begin(), vertices.end(), [&](Index v) {
      return factor_.row_of_copy(first_copy_[v]) >= factor_.eliminated_count();
    });
    if (!all_retained) return LaplaceSolver::solve_impulses(vertices);
    const Eigen::Index count = static_cast<Eigen::Index>(vertices.size());
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(glued_count_, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (glued_[vertices[i]] != none) pull(glued_[vertices[i]], i) = 1;
    }
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(factor_.cut_mesh().copy_count(), count);
    return finish(pull, x);
  }

 private:
  Eigen::MatrixXd glue() const {
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(glued_count_, glued_count_);
    const Eigen::MatrixXd& schur = factor_.schur();
    const std::vector<Index>& retained = factor_.retained();
    std::vector<Index> at(retained.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = glued_[factor_.cut_mesh().source[retained[i]]];
    for (std::size_t column = 0; column < at.size(); ++column) {
      if (at[column] == none) continue;
      for (std::size_t row = column; row < at.size(); ++row) {
        if (at[row] == none) continue;
        const double value = schur(row, column);
        lower(std::max(at[row], at[column]), std::min(at[row], at[column])) +=
            row != column && at[row] == at[column] ? 2 * value : value;
      }
    }
    return lower;
  }

  // x: half solved.
  Eigen::MatrixXd finish(Eigen::MatrixXd& pull, Eigen::MatrixXd& x) const {
    dense_->solve_in_place(pull);
    for (const Index copy : factor_.retained()) {
      const Index at = glued_[factor_.cut_mesh().source[copy]];
      const Index row = factor_.row_of_copy(copy);
      if (at == none)
        x.row(row).setZero();
      else
        x.row(row) = pull.row(at);
    }
    factor_.substitute(x);
    Eigen::MatrixXd out(first_copy_.size(), x.cols());
    for (Eigen::Index v = 0; v < out.rows(); ++v) out.row(v) = x.row(factor_.row_of_copy(first_copy_[v]));
    return out;
  }

  const CutFactor& factor_;
  std::vector<Index> glued_;       // (n) rows of the dense problem, none where held or eliminated
  std::vector<Index> first_copy_;  // (n)
  Index glued_count_ = 0;
  std::optional<DenseCholesky<double>> dense_;
};

}  // namespace

std::unique_ptr<LaplaceSolver> sparse_laplace(const HalfedgeMesh& mesh, const Geometry& geometry,
                                              std::vector<char> held) {
  if (std::none_of(held.begin(), held.end(), [](char h) { return h; })) held[0] = 1;  // fixes the constant
  return std::make_unique<SparseLaplace>(assemble_laplacian(mesh, geometry, held));
}

std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, Index vertex_count,
                                              const std::vector<char>& held) {
  return std::make_unique<LaplaceOnCut>(factor, vertex_count, held);
}

}  // namespace lsgp
