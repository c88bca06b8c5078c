// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of linear solvers.
#pragma once

#include "lsgp/errors.hpp"

namespace lsgp {

// SOLVER_FAILED, with its cause in terms of matrices.
class SolverFailure : public Error {
 public:
  enum class Cause { not_positive_definite, dependent_constraints, no_convergence };
  explicit SolverFailure(Cause cause) : Error(Code::solver_failed, "A linear solver failed."), cause(cause) {}
  Cause cause;
};

}  // namespace lsgp
