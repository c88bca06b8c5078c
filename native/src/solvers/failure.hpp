// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of linear solvers.
#pragma once

namespace lsgp {

[[noreturn]] void throw_unsolvable();  // SOLVER_FAILED: a matrix is not positive definite

}  // namespace lsgp
