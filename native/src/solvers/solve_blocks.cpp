// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/solve_blocks.hpp"

#include <algorithm>
#include <complex>

#include "base/memory.hpp"
#include "base/thread_team.hpp"
#include "solvers/cholesky.hpp"

namespace lsgp {

namespace {

constexpr Eigen::Index least_numbers =
    1 << 18;  // of all right-hand sides: some milliseconds, since threads take time to start

bool has_room(Eigen::Index blocks, Eigen::Index numbers) {
  const auto at_once = static_cast<double>(std::min<Eigen::Index>(blocks, thread_count()));
  return at_once * static_cast<double>(numbers) * sizeof(std::complex<double>) <= memory_left();
}

}  // namespace

void for_each_block(Eigen::Index sides, Eigen::Index rows, const std::function<void(const SolveBlock&)>& work) {
  constexpr Eigen::Index most = Cholesky<double>::solve_width;
  const Eigen::Index blocks = (sides + most - 1) / most, numbers = rows * most;
  const auto work_on = [&](Eigen::Index i) {
    const Eigen::Index begin = i * most, width = Cholesky<double>::width_for(sides - begin);
    work({begin, std::min(sides - begin, width), width});
  };
  if (blocks > 1 && thread_count() > 1 && sides * rows >= least_numbers && has_room(blocks, numbers)) {
    team_of_this_call().run_each(static_cast<int>(blocks), work_on);
  } else {
    for (Eigen::Index i = 0; i < blocks; ++i) work_on(i);
  }
}

}  // namespace lsgp
