// SPDX-License-Identifier: GPL-3.0-or-later
// Solves L y = b for the cotangent Laplacian of the surface itself, cuts glued together.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/array.hpp"
#include "systems/cut_factor.hpp"

namespace lsgp {

class LaplaceSolver {
 public:
  virtual ~LaplaceSolver() = default;
  // right_sides: (n, k), one per column.  The solution is 0 where y is held.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const;
  // The same for one right-hand side, (n), and for unit impulses at vertices, (n, vertices).
  struct Response {
    Eigen::VectorXd to_right_side;
    Eigen::MatrixXd to_impulses;
  };
  Response solve(const Eigen::VectorXd& right_side, const Array<Index>& impulses) const;

 protected:
  using Rows = Cholesky<double>::Rows;

  LaplaceSolver(Index row_count, PerVertex<Index> row_of_vertex)
      : row_count_(row_count), row_of_vertex_(std::move(row_of_vertex)) {}

  // A solve in two halves, as of Cholesky.
  virtual void eliminate(Rows& right_sides) const = 0;
  virtual void substitute(Rows& half_solved) const = 0;

 private:
  template <typename Visit>
  void for_each_row(Visit visit) const {
    for (std::size_t v = 0; v < row_of_vertex_.size(); ++v) {
      if (row_of_vertex_[v] != none) visit(static_cast<Index>(v), row_of_vertex_[v]);
    }
  }

  const Index row_count_;
  const PerVertex<Index> row_of_vertex_;  // none where y is 0
};

// held: where y is 0, at least at one vertex.
std::unique_ptr<LaplaceSolver> sparse_laplace(const MetricMesh& surface, const PerVertex<char>& held);
// The same with an existing factor; held vertices lie on cuts or boundaries.
std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, const PerVertex<char>& held);

}  // namespace lsgp
