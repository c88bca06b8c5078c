// SPDX-License-Identifier: GPL-3.0-or-later
#include "laplace_solver.hpp"

#include <algorithm>
#include <optional>

#include "energies/quadratic_forms.hpp"
#include "solvers/dense_cholesky.hpp"

namespace lsgp {

LaplaceSolver::Response LaplaceSolver::solve(const Eigen::VectorXd& right_side,
                                             const std::vector<Index>& impulses) const {
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(right_side.size(), static_cast<Eigen::Index>(impulses.size()) + 1);
  for (std::size_t i = 0; i < impulses.size(); ++i) sides(impulses[i], static_cast<Eigen::Index>(i)) = 1;
  sides.rightCols<1>() = right_side;
  Eigen::MatrixXd y = solve(sides);
  Response out{y.rightCols<1>(), {}};
  y.conservativeResize(Eigen::NoChange, y.cols() - 1);
  out.to_impulses = std::move(y);
  return out;
}

namespace {

class SparseLaplace final : public LaplaceSolver {
 public:
  explicit SparseLaplace(const Laplacian& laplacian)
      : row_of_vertex_(laplacian.row_of_vertex), factor_(laplacian.lower) {}

  using LaplaceSolver::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const override {
    Eigen::MatrixXd x(factor_.size(), right_sides.cols());
    for (std::size_t v = 0; v < row_of_vertex_.size(); ++v) {
      if (row_of_vertex_[v] != none) x.row(row_of_vertex_[v]) = right_sides.row(v);
    }
    x = factor_.solve(x);
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
  LaplaceOnCut(const CutFactor& factor, const std::vector<char>& held)
      : factor_(factor), row_of_vertex_(held.size()), place_(held.size(), none) {
    const CutMesh& cut_mesh = factor.cut_mesh();
    for (Index copy = cut_mesh.copy_count(); copy-- > 0;) {
      row_of_vertex_[cut_mesh.source[copy]] = factor.row_of_copy(copy);
    }
    for (const Index copy : factor.retained()) {
      const Index v = cut_mesh.source[copy];
      if (!held[v] && place_[v] == none) place_[v] = glued_count_++;
    }
    for (const Index copy : factor.retained()) place_of_retained_.push_back(place_[cut_mesh.source[copy]]);
    dense_.emplace(glue());
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const override {
    Eigen::MatrixXd out(right_sides.rows(), right_sides.cols());
    for (Eigen::Index begin = 0, used; begin < out.cols(); begin += used) {
      const Eigen::Index width = Cholesky<double>::width_for(out.cols() - begin);
      used = std::min(out.cols() - begin, width);
      // A right side acts on one copy of each vertex: they are one.
      Rows x = Rows::Zero(row_count(), width);
      for (Eigen::Index v = 0; v < out.rows(); ++v) {
        x.row(row_of_vertex_[v]).head(used) = right_sides.row(v).segment(begin, used);
      }
      factor_.eliminate(x);
      finish(pull_of(x), used, x);
      for (Eigen::Index v = 0; v < out.rows(); ++v) {
        out.row(v).segment(begin, used) = x.row(row_of_vertex_[v]).head(used);
      }
    }
    return out;
  }

  // Half a solve is saved where impulses act on retained copies, and where they act on what is held, all of it.
  Response solve(const Eigen::VectorXd& right_side, const std::vector<Index>& impulses) const override {
    std::vector<Eigen::Index> moving;
    for (std::size_t i = 0; i < impulses.size(); ++i) {
      if (row_of_vertex_[impulses[i]] < factor_.eliminated_count()) return LaplaceSolver::solve(right_side, impulses);
      if (place_[impulses[i]] != none) moving.push_back(static_cast<Eigen::Index>(i));
    }
    const Eigen::Index n = right_side.size(), count = static_cast<Eigen::Index>(moving.size()) + 1;
    Response out{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(impulses.size()))};
    Rows half_solved = Rows::Zero(row_count(), 1);
    for (Eigen::Index v = 0; v < n; ++v) half_solved(row_of_vertex_[v], 0) = right_side[v];
    factor_.eliminate(half_solved);
    for (Eigen::Index begin = 0, used; begin < count; begin += used) {
      const Eigen::Index width = Cholesky<double>::width_for(count - begin);
      used = std::min(count - begin, width);
      Rows x = Rows::Zero(row_count(), width);
      Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(glued_count_, width);
      if (begin == 0) {
        x.col(0) = half_solved;
        pull.col(0) = pull_of(half_solved);
      }
      for (Eigen::Index k = begin == 0 ? 1 : 0; k < used; ++k) pull(place_[impulses[moving[begin + k - 1]]], k) = 1;
      finish(std::move(pull), used, x);
      for (Eigen::Index k = 0; k < used; ++k) {
        double* column = begin + k == 0 ? out.to_right_side.data() : out.to_impulses.col(moving[begin + k - 1]).data();
        for (Eigen::Index v = 0; v < n; ++v) column[v] = x(row_of_vertex_[v], k);
      }
    }
    return out;
  }

 private:
  using Rows = CutFactor::Rows;

  Eigen::Index row_count() const { return factor_.cut_mesh().copy_count(); }

  Eigen::MatrixXd glue() const {
    Eigen::MatrixXd form = Eigen::MatrixXd::Zero(glued_count_, glued_count_);
    const std::vector<Index>& at = place_of_retained_;
    for (std::size_t column = 0; column < at.size(); ++column) {
      if (at[column] == none) continue;
      for (std::size_t row = 0; row < at.size(); ++row) {
        if (at[row] >= at[column]) form(at[row], at[column]) += factor_.schur()(row, column);
      }
    }
    return form;
  }

  // The right side of the retained vertices' own system, (glued, width).
  Eigen::MatrixXd pull_of(const Rows& half_solved) const {
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(glued_count_, half_solved.cols());
    for (std::size_t i = 0; i < place_of_retained_.size(); ++i) {
      if (place_of_retained_[i] != none)
        pull.row(place_of_retained_[i]) += half_solved.row(factor_.eliminated_count() + i);
    }
    return pull;
  }

  // x: half solved.
  void finish(Eigen::MatrixXd pull, Eigen::Index sides, Rows& x) const {
    dense_->solve_in_place(pull);
    for (std::size_t i = 0; i < place_of_retained_.size(); ++i) {
      auto row = x.row(factor_.eliminated_count() + i);
      if (place_of_retained_[i] == none)
        row.setZero();
      else
        row = pull.row(place_of_retained_[i]);
    }
    factor_.substitute(x, sides);
  }

  const CutFactor& factor_;
  std::vector<Index> row_of_vertex_;      // (n) of its first copy
  std::vector<Index> place_;              // (n) in the dense problem, none where held or eliminated
  std::vector<Index> place_of_retained_;  // (retained)
  Index glued_count_ = 0;
  std::optional<DenseCholesky<double>> dense_;
};

}  // namespace

std::unique_ptr<LaplaceSolver> sparse_laplace(const HalfedgeMesh& mesh, const Geometry& geometry,
                                              const std::vector<char>& held) {
  return std::make_unique<SparseLaplace>(assemble_laplacian(mesh, geometry, held));
}

std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, const std::vector<char>& held) {
  return std::make_unique<LaplaceOnCut>(factor, held);
}

}  // namespace lsgp
