// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares fit of the map to given Jacobians: one solve with the Dirichlet form under the transitions.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "cut/cut_mesh.hpp"
#include "transitions/transitions.hpp"

namespace lsgp {

// The Jacobian of a map in every triangle's own frame.
struct Jacobians {
  Eigen::VectorXcd f_z, f_zbar;  // (m)
};

// The right-hand side of the fit to target Jacobians, (copies).
Eigen::VectorXcd pull_of(const CutSurface& surface, const Jacobians& jacobians);

class PoissonSystem {
 public:
  // Solved on the cut if the surface has a factor, sparse otherwise.
  PoissonSystem(const CutSurface& surface, const Reduction& reduction);
  ~PoissonSystem();

  // Positions u + iv of all copies.
  Eigen::VectorXcd fit(const Jacobians& jacobians) const;

 private:
  class Solver;
  class Sparse;
  class OnCut;
  std::unique_ptr<Solver> solver_;
};

}  // namespace lsgp
