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
  virtual ~LaplaceSolver() = default;
  // right_sides: (n, k), one a column.  0 where y is held.
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const = 0;
  // The same for one right side, (n, 1), and for impulses of 1 at vertices, (n, vertices).
  struct Response {
    Eigen::VectorXd to_right_side;
    Eigen::MatrixXd to_impulses;
  };
  virtual Response solve(const Eigen::VectorXd& right_side, const std::vector<Index>& impulses) const;
};

// held: (n) where y is 0, somewhere at least.
std::unique_ptr<LaplaceSolver> sparse_laplace(const HalfedgeMesh& mesh, const Geometry& geometry,
                                              const std::vector<char>& held);
// The same on a factor that is there already; held vertices lie on cuts or borders.
std::unique_ptr<LaplaceSolver> laplace_on_cut(const CutFactor& factor, const std::vector<char>& held);

}  // namespace lsgp
