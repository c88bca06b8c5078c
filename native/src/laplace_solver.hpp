// SPDX-License-Identifier: GPL-3.0-or-later
// Solves L y = b for the cotangent Laplacian of the surface itself, cuts glued together.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cut_factor.hpp"

namespace lsgp {

class LaplaceSolver {
 public:
  explicit LaplaceSolver(Index vertex_count) : vertex_count_(vertex_count) {}
  virtual ~LaplaceSolver() = default;
  // right_sides: (n, k), one a column.  0 where y is held.
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const = 0;
  // The same for impulses of 1 at vertices, (n, vertices).
  virtual Eigen::MatrixXd solve_impulses(const std::vector<Index>& vertices) const;

 protected:
  const Index vertex_count_;
};

// held: (n) where y is 0.  Where nothing is held, y is known up to a constant and the right sides add up to 0.
std::unique_ptr<LaplaceSolver> sparse_laplace(const HalfedgeMesh& mesh, const Geometry& geometry,
                                              std::vector<char> held);
// The same on a factor that is there already; held vertices lie on cuts or borders.
std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, Index vertex_count,
                                              const std::vector<char>& held);

}  // namespace lsgp
