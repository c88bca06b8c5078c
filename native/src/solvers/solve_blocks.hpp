// SPDX-License-Identifier: GPL-3.0-or-later
// Right sides of a linear system in blocks that a solve takes at once, on several threads.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace lsgp {

struct SolveBlock {
  Eigen::Index begin;  // its first right side
  Eigen::Index used;   // how many there are
  Eigen::Index width;  // with padding, see Cholesky
};

// Calls work for all blocks, in any order and at the same time where there is memory for that.  rows: numbers of a
// right side. Each block needs numbers of its own, rows times width of them, complex at most.
void for_each_block(Eigen::Index sides, Eigen::Index rows, const std::function<void(const SolveBlock&)>& work);

}  // namespace lsgp
