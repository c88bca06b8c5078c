// SPDX-License-Identifier: GPL-3.0-or-later
// The right-hand sides of a linear system in blocks that are solved at once, on several threads.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace lsgp {

struct SolveBlock {
  Eigen::Index begin;  // its first right-hand side
  Eigen::Index used;   // the number of them
  Eigen::Index width;  // with padding, see Cholesky
};

// Calls work for all blocks, in any order and at the same time where there is memory for that.  rows: of a right-hand
// side. Each block allocates rows times width numbers, which may be complex.
void for_each_block(Eigen::Index sides, Eigen::Index rows, const std::function<void(const SolveBlock&)>& work);

}  // namespace lsgp
