// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/laplace_solver.hpp"

#include <optional>

#include "solvers/dense_cholesky.hpp"
#include "solvers/linear_algebra_counter.hpp"
#include "solvers/solve_blocks.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

Eigen::MatrixXd LaplaceSolver::solve(const Eigen::MatrixXd& right_sides) const {
  count_back_substitutions(static_cast<int>(right_sides.cols()));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(right_sides.rows(), right_sides.cols());
  for_each_block(out.cols(), row_count_, [&](const SolveBlock& block) {
    Rows x = Rows::Zero(row_count_, block.width);
    for_each_row(
        [&](Index v, Index row) { x.row(row).head(block.used) = right_sides.row(v).segment(block.begin, block.used); });
    eliminate(x);
    substitute(x);
    for_each_row(
        [&](Index v, Index row) { out.row(v).segment(block.begin, block.used) = x.row(row).head(block.used); });
  });
  return out;
}

// Half a solve costs next to nothing for a single impulse, so the right-hand side is processed separately up to there.
LaplaceSolver::Response LaplaceSolver::solve(const Eigen::VectorXd& right_side, const Array<Index>& impulses) const {
  const Eigen::Index n = right_side.size();
  Response out{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(impulses.size()))};
  struct Side {
    Index row;  // of the impulse
    double* solution;
  };
  Array<Side> sides{{none, out.to_right_side.data()}};
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    const Index row = row_of_vertex_[impulses[i]];
    if (row != none) sides.push_back({row, out.to_impulses.col(static_cast<Eigen::Index>(i)).data()});
  }
  Rows half_solved = Rows::Zero(row_count_, 1);
  for_each_row([&](Index v, Index row) { half_solved(row, 0) = right_side[v]; });
  eliminate(half_solved);
  count_back_substitutions(static_cast<int>(sides.size()));
  for_each_block(ssize(sides), row_count_, [&](const SolveBlock& block) {
    const Side* own = sides.data() + block.begin;
    Rows x = Rows::Zero(row_count_, block.width);
    for (Eigen::Index k = 0; k < block.used; ++k) {
      if (own[k].row != none) x(own[k].row, k) = 1;
    }
    eliminate(x);
    if (block.begin == 0) x.col(0) = half_solved;
    substitute(x);
    for_each_row([&](Index v, Index row) {
      for (Eigen::Index k = 0; k < block.used; ++k) own[k].solution[v] = x(row, k);
    });
  });
  return out;
}

namespace {

class SparseLaplace final : public LaplaceSolver {
 public:
  SparseLaplace(Cholesky<double> factor, const PerVertex<Index>& row_of_vertex)
      : LaplaceSolver(static_cast<Index>(factor.size()), places(factor, row_of_vertex)), factor_(std::move(factor)) {}

 private:
  static PerVertex<Index> places(const Cholesky<double>& factor, PerVertex<Index> rows) {
    for (Index& row : rows) {
      if (row != none) row = factor.place(row);
    }
    return rows;
  }
  void eliminate(Rows& right_sides) const override { factor_.eliminate(right_sides); }
  void substitute(Rows& half_solved) const override { factor_.substitute(half_solved); }

  Cholesky<double> factor_;
};

class LaplaceOnCut final : public LaplaceSolver {
 public:
  LaplaceOnCut(const CutFactor& factor, const PerVertex<char>& held)
      : LaplaceSolver(factor.cut_mesh().copy_count(), rows_of_vertices(factor, held)), factor_(factor) {
    PerVertex<Index> place_of_vertex(held.size(), none);
    for (const Index copy : factor.retained()) {
      const Index v = factor.cut_mesh().source[copy];
      if (!held[v] && place_of_vertex[v] == none) place_of_vertex[v] = glued_count_++;
      place_.push_back(place_of_vertex[v]);
    }
    dense_.emplace(glue());
  }

 private:
  // A right-hand side acts on the first copy of each vertex, since all of them are the same unknown.
  static PerVertex<Index> rows_of_vertices(const CutFactor& factor, const PerVertex<char>& held) {
    PerVertex<Index> row(held.size(), none);
    for (Index copy = factor.cut_mesh().copy_count(); copy-- > 0;) {
      const Index v = factor.cut_mesh().source[copy];
      if (!held[v]) row[v] = factor.row_of_copy(copy);
    }
    return row;
  }

  // Lower triangle.
  Eigen::MatrixXd glue() const {
    Eigen::MatrixXd form = Eigen::MatrixXd::Zero(glued_count_, glued_count_);
    for (Eigen::Index column = 0; column < ssize(place_); ++column) {
      if (place_[column] == none) continue;
      for (Eigen::Index row = 0; row < ssize(place_); ++row) {
        if (place_[row] >= place_[column]) form(place_[row], place_[column]) += factor_.schur()(row, column);
      }
    }
    return form;
  }

  void eliminate(Rows& right_sides) const override { factor_.eliminate(right_sides); }

  void substitute(Rows& half_solved) const override {
    auto retained = half_solved.bottomRows(factor_.retained_count());
    Eigen::MatrixXd glued = Eigen::MatrixXd::Zero(glued_count_, half_solved.cols());
    for (std::size_t i = 0; i < place_.size(); ++i) {
      if (place_[i] != none) glued.row(place_[i]) += retained.row(static_cast<Eigen::Index>(i));
    }
    glued = dense_->solve(glued);
    for (std::size_t i = 0; i < place_.size(); ++i) {
      auto row = retained.row(static_cast<Eigen::Index>(i));
      if (place_[i] == none)
        row.setZero();
      else
        row = glued.row(place_[i]);
    }
    factor_.substitute(half_solved);
  }

  const CutFactor& factor_;
  Array<Index> place_;  // (retained) in the dense problem, none where held
  Index glued_count_ = 0;
  std::optional<DenseCholesky<double>> dense_;
};

}  // namespace

std::unique_ptr<LaplaceSolver> sparse_laplace(const MetricMesh& surface, const PerVertex<char>& held) {
  const Laplacian laplacian = assemble_laplacian(surface, held);
  return std::make_unique<SparseLaplace>(Cholesky<double>(laplacian.lower), laplacian.row_of_vertex);
}

std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, const PerVertex<char>& held) {
  return std::make_unique<LaplaceOnCut>(factor, held);
}

}  // namespace lsgp
